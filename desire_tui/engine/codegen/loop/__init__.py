"""The run loop of rules 0 … 8."""
