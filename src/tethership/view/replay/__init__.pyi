from .page import replay_text as replay_text
from .page import write_replay as write_replay
