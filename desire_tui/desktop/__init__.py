"""What only the wired app uses: main screen, engine thread and its messages, order of keys, command lines."""
