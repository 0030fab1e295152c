"""What many runs of one process leave behind."""

from __future__ import annotations

import subprocess
import sys

MANY = """
import resource, threading
resource.setrlimit(resource.RLIMIT_AS, (16_000_000 * 1024,) * 2)
import desire_tui
text = "k = 1 | x = 1 | TMAX = 1\\ndrun\\nDYNAMIC\\nd/dt x = -k*x\\ndispt x\\n"
model = desire_tui.load(text)
for number in range(50):
    model.run(k=number)
kept = [desire_tui.Session() for _ in range(6)]
for number in range(50):
    assert desire_tui.run(text, set={"k": number}).status == "done"
assert threading.active_count() <= 4, threading.enumerate()
"""


def test_many_runs_live_in_limited_address_space_with_a_few_threads():
    done = subprocess.run(
        [sys.executable, "-c", MANY], capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, done.stderr
