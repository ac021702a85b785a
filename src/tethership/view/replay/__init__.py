"""A flight replayed in a browser: one self-contained page with the ship in space and its histories."""

from tethership.view.replay.page import replay_text, write_replay

__all__ = ["replay_text", "write_replay"]
