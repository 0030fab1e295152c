"""What a script is made of: blocks, jumps, labels, definitions, data."""
