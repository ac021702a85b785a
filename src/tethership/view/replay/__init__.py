"""A flight replayed in a browser: one self-contained page with the ship in space and its histories."""

from tethership.view.replay.page import write_replay

__all__ = ["write_replay"]
