"""Loops of large models on all cores: threads that wait in native code, and the code that shares a loop."""
