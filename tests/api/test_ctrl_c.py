"""Ctrl-C in a caller's loop: KeyboardInterrupt at once, whatever goes on, and everything works afterwards."""

from __future__ import annotations

import signal
import subprocess
import sys
from threading import Timer

CHILD = """
import sys, threading, time
import desire_tui

text = "k = 1 | x = 1 | DT = 0.001 | NN = 2 | TMAX = 1E9\\ndrun\\nDYNAMIC\\nd/dt x = -k*x\\ndispt x\\n"
short = text.replace("1E9", "1")
model, study = desire_tui.load(text), desire_tui.load(short)
for _ in range(3):
    desire_tui.run(text, set={"TMAX": 1})
study.sweep(k=[1, 2])

def loop(work):
    while True:
        work()

stages = {
    "one long run": model.run,
    "short runs": lambda: loop(lambda: study.run(k=2)),
    "a program": lambda: desire_tui.run(text.replace("drun", "drun | drun")),
    "a repeated program": lambda: desire_tui.run(text),
    "repeated programs": lambda: loop(lambda: desire_tui.run(short)),
    "a sweep": lambda: model.sweep(k=[1, 2, 3], workers=1),
    "a sweep in threads": lambda: model.sweep(k=[1, 2, 3, 4, 5], workers=2),
    "a short sweep": lambda: loop(lambda: study.sweep(k=[1, 2, 3], keep="last")),
}
for name, stage in stages.items():
    try:
        print(name, flush=True)
        stage()
    except KeyboardInterrupt:
        print("interrupted", flush=True)
        sys.stdin.readline()
assert study.run(k=0)["x"][-1] == 1 and study.sweep(k=[0, 0], workers=2)["x"].values.min() == 1
assert desire_tui.run(short, set={"k": 0})["x"] == 1
for thread in threading.enumerate():
    if "sweep" in thread.name or "batch" in thread.name:
        thread.join(60)  # its work is over; on a busy machine it may still be ending
        assert not thread.is_alive(), thread.name
print("all is well", flush=True)
"""


def test_ctrl_c():
    with subprocess.Popen(
        [sys.executable, "-c", CHILD], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        text=True,
    ) as child:  # fmt: skip
        heard, watchdog = [], Timer(120, child.kill)
        watchdog.start()
        for line in child.stdout:
            heard.append(line.strip())
            if line == "interrupted\n":
                child.stdin.write("\n")
                child.stdin.flush()
            elif line != "all is well\n":
                child.send_signal(signal.SIGINT)
        watchdog.cancel()
        trouble = child.stderr.read()
    assert heard[1::2] == ["interrupted"] * 8, (heard, trouble)
    assert heard[-1] == "all is well", trouble
    assert trouble == ""
