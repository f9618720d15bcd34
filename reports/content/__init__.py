"""What the pages say, whatever they are printed on: chapters made of a few kinds of block."""
