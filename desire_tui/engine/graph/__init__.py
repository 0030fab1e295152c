"""What the display statements mean: frames, curves, colours, keys, points. No drawing (language.md 13)."""
