"""A run as one C99 file: the segment's passes, the rule, the samples.

`functions` has the library, `expressions` and `statements` write a pass, `rule` the steps, `frame` what is
around them, `model_file` all of it. Arithmetic is written as the engine does it: with the same C library, and
without contraction to fused multiply-adds, samples of scalar models are the engine's bit for bit.
"""
