"""The time series for other programs: CSV and MATLAB files."""

from .series import export_files as export_files
