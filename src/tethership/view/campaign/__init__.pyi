from .report import write_campaign as write_campaign
from .setting import trusted as trusted
