"""The file a user writes."""
