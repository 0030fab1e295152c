"""LLVM IR as strings: what every other room writes with."""
