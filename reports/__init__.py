"""Say it: the record and the pages made from it."""
