"""LLVM: texts compiled, kept, improved in the background."""
