"""The record: its classes are its schema; writers and readers share them."""

from .arrays import Array as Array
from .arrays import RecordError as RecordError
from .arrays import arrays_bytes as arrays_bytes
from .document import record_schema as record_schema
from .store import ARRAYS_NAME as ARRAYS_NAME
from .store import DOCUMENT_NAME as DOCUMENT_NAME
from .store import Record as Record
from .store import read_record as read_record
from .store import write_record as write_record
from .store import write_record_to as write_record_to
