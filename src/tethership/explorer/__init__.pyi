from . import server as server
from .server import Explorer as Explorer
from .server import serve_until_signal as serve_until_signal
