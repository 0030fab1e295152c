"""What a process stores of a large program, so that a later one starts it without reading all of it again.

Of 1,401 equations a later process wants to know little: which states there are and where, what is sampled,
which files hold the machine code. The equations themselves are parsed and lowered when somebody asks for them
(`nodes.deferred_text`, `lowered.deferred_segment`): an error message, a sensitivity, an export.

- `program_start`: what a session asks instead of parser and lowering, and tells after a run
- `program_facts`, `segment_facts`: what is stored of a parsed program, of a lowered segment, as plain data
- `start_file`: where it is stored, under a name made of all it depends on
- `engine_digest`: the engine that made it

Facts are stored only if what is restored from them equals what they were taken from, field by field.
"""
