from .record import Record as Record
from .record import read_record as read_record
