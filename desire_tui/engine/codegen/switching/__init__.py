"""`integration.switching` as native code."""
