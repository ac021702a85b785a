from .outcome import TrimOutcome as TrimOutcome
from .problem import Question as Question
from .problem import ask as ask
from .problem import pose as pose
from .trim import TrimPoint as TrimPoint
from .trim import trim as trim
