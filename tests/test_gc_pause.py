"""What is made while the garbage collector waits becomes old unseen; in processes where nothing is frozen."""

import subprocess
import sys


def _succeeds(code):
    subprocess.run([sys.executable, "-c", "import gc, weakref\nfrom desire_tui.engine import gc_pause\n"
                    "pause = gc_pause.undisturbed_allocation\n" + code], check=True)  # fmt: skip


def test_many_objects_become_old_and_few_stay_young():
    _succeeds("""
kept = [[] for _ in range(3)]
gc.collect()
with pause:
    assert not gc.isenabled()
    few = [[] for _ in range(100)]
assert gc.isenabled() and any(thing is few[0] for thing in gc.get_objects(0))
with pause:
    many = [[] for _ in range(20_000)]
assert gc.isenabled() and not any(thing is many[-1] for thing in gc.get_objects(0))
assert any(thing is many[-1] for thing in gc.get_objects(2)) and gc.get_freeze_count() == 0
""")


def test_what_somebody_froze_stays_frozen():
    _succeeds("""
gc.freeze()
count = gc.get_freeze_count()
for _ in range(2):
    with pause:
        many = [[] for _ in range(20_000)]
assert gc.get_freeze_count() == count and gc.isenabled()
""")


def test_cycles_that_became_old_unseen_are_collected_in_the_end():
    """Each use begins the collector's counts anew: without a limit none of these would ever go."""
    _succeeds("""
class Ring:
    pass

gc_pause._UNSEEN_MOST = 100_000
gone = []
for number in range(400):
    with pause:
        ring = Ring()
        ring.own = ring
        weakref.finalize(ring, gone.append, number)
        many = [[] for _ in range(6_000)]
assert len(gone) > 200
""")
