"""Random inputs, generated and mutated, held to what must always be true: `make fuzz`."""
