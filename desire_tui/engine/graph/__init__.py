"""What a display statement means: frames, curves, colours, keys. No drawing."""
