"""Say it: the record and the pages made from it. Computes nothing."""

from .record import Record as Record
from .record import RecordError as RecordError
from .record import read_record as read_record
from .record import write_record as write_record
