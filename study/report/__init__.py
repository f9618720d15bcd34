"""The report: everything its pages show, in one record."""
