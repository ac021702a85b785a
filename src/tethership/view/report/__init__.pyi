from .content import Table as Table
from .page_file import page_text as page_text
from .report import Figure as Figure
from .report import Section as Section
from .report import write_report as write_report
