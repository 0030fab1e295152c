"""The pool's native code: a loop over blocks, done by whoever is there; threads that sleep between loops.

Blocks are cut at fixed places, so that nobody can tell from the results who did which. Each member of the
pool has a ticket, the blocks of its own part that nobody has taken yet: what a part reads and writes stays in
the cache of its core from loop to loop. Whoever has waited in vain for some 10 µs takes from the others'
parts: a thread that the system has put aside holds up one block at most. A ticket is one number of
64 bits, taken by compare-and-swap (Herlihy & Shavit, The Art of Multiprocessor Programming, 2008, 5.8): the
loop's number above bit 32, then 16 bits each for the part's end and its next block. What else belongs to a
loop is written before its tickets and stays until the last block is done.

Threads look for work for some 50 µs before they go to sleep on a condition variable of POSIX; a loop that
begins while they sleep wakes them and starts without them.
"""

from __future__ import annotations

MEMBERS_MOST = 64
"""Tickets, each in a cache line of its own."""
BLOCKS_MOST = (1 << 16) - 1
"""In one loop: 16 bits of a ticket."""
_LOOKS = 1000
"""Pauses of some 50 ns before a thread goes to sleep, or gives its core to whoever else wants it."""

_PATIENCE = 200
"""Pauses before somebody takes from the others' parts: those at work must not lose their cache's content."""

_PAUSES = {
    "x86_64": ("declare void @llvm.x86.sse2.pause()", "call void @llvm.x86.sse2.pause()"),
    "aarch64": ("declare void @llvm.aarch64.hint(i32)", "call void @llvm.aarch64.hint(i32 1)"),
    "arm64": ("declare void @llvm.aarch64.hint(i32)", "call void @llvm.aarch64.hint(i32 1)"),
}


def pool_text(triple: str) -> tuple[list[str], list[str]]:
    """Return the pool's functions and what must be declared.

    `void pool.open(i64 members)`: before the threads start, and after a fork; the caller is a member.
    `void pool.share(body, values, derivatives, context, i64 count, i64 block)`: `body(values, derivatives,
    context, i64 first, i64 end)` for all blocks of `block` elements, the last one perhaps shorter. Where
    another thread of the process has the pool, or there are too many blocks, the caller does all of them.
    `void pool.claim()`: waits until no loop goes on, and lets none begin until `pool.open`.
    `void pool.work(i64 member)`: what a thread runs until `void pool.close()`.
    """
    declared, pause = _PAUSES.get(triple.split("-", maxsplit=1)[0], ("", ""))
    functions = [_OPEN, _CLAIM, _SHARE, _TAKE, _WORK, _CLOSE]
    filled = [
        function.replace("PAUSE", pause).replace("LOOKS", str(_LOOKS)).replace("PATIENCE", str(_PATIENCE))
        for function in functions
    ]
    tickets = f"@pool.tickets = internal global [{8 * MEMBERS_MOST} x i64] zeroinitializer, align 64"
    return filled, [*_DECLARATIONS, tickets, *([declared] if declared else [])]


_DECLARATIONS = [
    "@pool.mutex = internal global [16 x i64] zeroinitializer, align 64",
    "@pool.wake = internal global [16 x i64] zeroinitializer, align 64",
    "@pool.members = internal global i64 1, align 64",
    "@pool.closing = internal global i64 0, align 8",
    "@pool.sleepers = internal global i64 0, align 64",
    "@pool.owned = internal global i64 0, align 64",
    "@pool.done = internal global i64 0, align 64",
    "@pool.job = internal global { ptr, ptr, ptr, ptr, i64, i64, i64 } zeroinitializer, align 64",
    "declare i32 @pthread_mutex_init(ptr, ptr)",
    "declare i32 @pthread_mutex_lock(ptr)",
    "declare i32 @pthread_mutex_unlock(ptr)",
    "declare i32 @pthread_cond_init(ptr, ptr)",
    "declare i32 @pthread_cond_wait(ptr, ptr)",
    "declare i32 @pthread_cond_broadcast(ptr)",
    "declare i32 @sched_yield()",
]
"""A mutex and a condition variable take at most 64 bytes on Linux and macOS; here each has 128."""

_JOB = "{ ptr, ptr, ptr, ptr, i64, i64, i64 }"
"""Body, values, derivatives, context; elements, elements of a block, the loop's number."""

_OPEN = """define void @pool.open(i64 %members) #0 {
  %a = call i32 @pthread_mutex_init(ptr @pool.mutex, ptr null)
  %b = call i32 @pthread_cond_init(ptr @pool.wake, ptr null)
  store atomic i64 0, ptr @pool.sleepers seq_cst, align 8
  store atomic i64 0, ptr @pool.owned seq_cst, align 8
  store atomic i64 0, ptr @pool.closing seq_cst, align 8
  store atomic i64 %members, ptr @pool.members seq_cst, align 8
  ret void
}"""

_CLAIM = """define void @pool.claim() #0 {
entry:
  br label %try
try:
  %asked = cmpxchg ptr @pool.owned, i64 0, i64 1 seq_cst seq_cst
  %ours = extractvalue { i64, i1 } %asked, 1
  br i1 %ours, label %out, label %yield
yield:
  %y = call i32 @sched_yield()
  br label %try
out:
  ret void
}"""

_SHARE = f"""define void @pool.share(ptr %body, ptr %v, ptr %dx, ptr %c, i64 %count, i64 %block) #0 {{
entry:
  %most = add i64 %count, %block
  %above = add i64 %most, -1
  %blocks = sdiv i64 %above, %block
  %members = load atomic i64, ptr @pool.members monotonic, align 8
  %alone = icmp sle i64 %members, 1
  %little = icmp sle i64 %blocks, 1
  %much = icmp sgt i64 %blocks, {BLOCKS_MOST}
  %o1 = or i1 %alone, %little
  %o2 = or i1 %o1, %much
  br i1 %o2, label %self, label %ask
ask:
  %asked = cmpxchg ptr @pool.owned, i64 0, i64 1 seq_cst seq_cst
  %ours = extractvalue {{ i64, i1 }} %asked, 1
  br i1 %ours, label %publish, label %self
publish:
  %sharers = load atomic i64, ptr @pool.members seq_cst, align 8 ; a claim may have come between
  store ptr %body, ptr @pool.job
  store ptr %v, ptr getelementptr ({_JOB}, ptr @pool.job, i64 0, i32 1)
  store ptr %dx, ptr getelementptr ({_JOB}, ptr @pool.job, i64 0, i32 2)
  store ptr %c, ptr getelementptr ({_JOB}, ptr @pool.job, i64 0, i32 3)
  store i64 %count, ptr getelementptr ({_JOB}, ptr @pool.job, i64 0, i32 4)
  store i64 %block, ptr getelementptr ({_JOB}, ptr @pool.job, i64 0, i32 5)
  %before = load i64, ptr getelementptr ({_JOB}, ptr @pool.job, i64 0, i32 6)
  %number = add i64 %before, 1
  store i64 %number, ptr getelementptr ({_JOB}, ptr @pool.job, i64 0, i32 6)
  store atomic i64 0, ptr @pool.done seq_cst, align 8
  %high = shl i64 %number, 32
  br label %part
part:
  %p = phi i64 [ 0, %publish ], [ %q, %part ]
  %q = add i64 %p, 1
  %f = mul i64 %p, %blocks
  %first = udiv i64 %f, %sharers
  %e = mul i64 %q, %blocks
  %end = udiv i64 %e, %sharers
  %middle = shl i64 %end, 16
  %low = or i64 %first, %middle
  %ticket = or i64 %low, %high
  %place = mul i64 %p, 8
  %at = getelementptr i64, ptr @pool.tickets, i64 %place
  store atomic i64 %ticket, ptr %at seq_cst, align 8
  %more = icmp slt i64 %q, %sharers
  br i1 %more, label %part, label %published
published:
  %sleepers = load atomic i64, ptr @pool.sleepers seq_cst, align 8
  %asleep = icmp sgt i64 %sleepers, 0
  br i1 %asleep, label %rouse, label %begin
rouse:
  %r1 = call i32 @pthread_mutex_lock(ptr @pool.mutex)
  %r2 = call i32 @pthread_cond_broadcast(ptr @pool.wake)
  %r3 = call i32 @pthread_mutex_unlock(ptr @pool.mutex)
  br label %begin
begin:
  %mine = call i64 @pool.take(i64 0, i64 1)
  br label %wait
wait:
  %looks = phi i64 [ 0, %begin ], [ %looked, %again ]
  %done = load atomic i64, ptr @pool.done seq_cst, align 8
  %all = icmp sge i64 %done, %blocks
  br i1 %all, label %over, label %pause
pause:
  PAUSE
  %looked = add i64 %looks, 1
  %enough = icmp eq i64 %looked, PATIENCE
  br i1 %enough, label %help, label %look.on
help:
  %theirs = call i64 @pool.take(i64 0, i64 %sharers)
  br label %again
look.on:
  %long = icmp sgt i64 %looked, LOOKS
  br i1 %long, label %yield, label %again
yield:
  %y = call i32 @sched_yield()
  br label %again
again:
  br label %wait
over:
  store atomic i64 0, ptr @pool.owned seq_cst, align 8
  ret void
self:
  br label %head
head:
  %s = phi i64 [ 0, %self ], [ %t, %do ]
  %left = icmp slt i64 %s, %count
  br i1 %left, label %do, label %out
do:
  %t = add i64 %s, %block
  %short = icmp slt i64 %t, %count
  %stop = select i1 %short, i64 %t, i64 %count
  call void %body(ptr %v, ptr %dx, ptr %c, i64 %s, i64 %stop)
  br label %head
out:
  ret void
}}"""

_TAKE = f"""define internal i64 @pool.take(i64 %me, i64 %parts) #0 {{
entry:
  %members = load atomic i64, ptr @pool.members monotonic, align 8
  br label %part
part:
  %p = phi i64 [ 0, %entry ], [ %next, %empty ]
  %had = phi i64 [ 0, %entry ], [ %got, %empty ]
  %some = icmp slt i64 %p, %parts
  br i1 %some, label %look, label %tell
look:
  %sum = add i64 %me, %p
  %whose = urem i64 %sum, %members
  %place = mul i64 %whose, 8
  %at = getelementptr i64, ptr @pool.tickets, i64 %place
  br label %try
try:
  %got = phi i64 [ %had, %look ], [ %got, %claim ], [ %more, %do ]
  %ticket = load atomic i64, ptr %at seq_cst, align 8
  %number = and i64 %ticket, 65535
  %shifted = lshr i64 %ticket, 16
  %end = and i64 %shifted, 65535
  %there = icmp ult i64 %number, %end
  br i1 %there, label %claim, label %empty
claim:
  %taken = add i64 %ticket, 1
  %asked = cmpxchg ptr %at, i64 %ticket, i64 %taken seq_cst seq_cst
  %ours = extractvalue {{ i64, i1 }} %asked, 1
  br i1 %ours, label %do, label %try
do:
  %body = load ptr, ptr @pool.job
  %v = load ptr, ptr getelementptr ({_JOB}, ptr @pool.job, i64 0, i32 1)
  %dx = load ptr, ptr getelementptr ({_JOB}, ptr @pool.job, i64 0, i32 2)
  %c = load ptr, ptr getelementptr ({_JOB}, ptr @pool.job, i64 0, i32 3)
  %count = load i64, ptr getelementptr ({_JOB}, ptr @pool.job, i64 0, i32 4)
  %block = load i64, ptr getelementptr ({_JOB}, ptr @pool.job, i64 0, i32 5)
  %first = mul i64 %number, %block
  %behind = add i64 %first, %block
  %short = icmp slt i64 %behind, %count
  %stop = select i1 %short, i64 %behind, i64 %count
  call void %body(ptr %v, ptr %dx, ptr %c, i64 %first, i64 %stop)
  %more = add i64 %got, 1
  br label %try
empty:
  %next = add i64 %p, 1
  br label %part
tell:
  %any = icmp sgt i64 %had, 0
  br i1 %any, label %add, label %out
add:
  %counted = atomicrmw add ptr @pool.done, i64 %had seq_cst
  br label %out
out:
  ret i64 %had
}}"""

_WORK = """define void @pool.work(i64 %me) #0 {
entry:
  br label %look
look:
  %looks = phi i64 [ 0, %entry ], [ 0, %rested ], [ %looked, %pause ]
  %closing = load atomic i64, ptr @pool.closing seq_cst, align 8
  %over = icmp ne i64 %closing, 0
  br i1 %over, label %out, label %take
take:
  %members = load atomic i64, ptr @pool.members monotonic, align 8
  %enough = icmp eq i64 %looks, PATIENCE
  %parts = select i1 %enough, i64 %members, i64 1
  %got = call i64 @pool.take(i64 %me, i64 %parts)
  %none = icmp eq i64 %got, 0
  %one.more = add i64 %looks, 1
  %looked = select i1 %none, i64 %one.more, i64 0
  %long = icmp sgt i64 %looked, LOOKS
  br i1 %long, label %rest, label %pause
pause:
  PAUSE
  br label %look
rest:
  %a = call i32 @pthread_mutex_lock(ptr @pool.mutex)
  %b = atomicrmw add ptr @pool.sleepers, i64 1 seq_cst
  br label %sleep
sleep:
  %over.now = load atomic i64, ptr @pool.closing seq_cst, align 8
  %is.over = icmp ne i64 %over.now, 0
  br i1 %is.over, label %rise, label %some
some:
  br label %part
part:
  %p = phi i64 [ 0, %some ], [ %q, %none.here ]
  %left = icmp slt i64 %p, %members
  br i1 %left, label %inspect, label %wait
inspect:
  %place = mul i64 %p, 8
  %at = getelementptr i64, ptr @pool.tickets, i64 %place
  %ticket = load atomic i64, ptr %at seq_cst, align 8
  %number = and i64 %ticket, 65535
  %shifted = lshr i64 %ticket, 16
  %end = and i64 %shifted, 65535
  %there = icmp ult i64 %number, %end
  br i1 %there, label %rise, label %none.here
none.here:
  %q = add i64 %p, 1
  br label %part
wait:
  %c = call i32 @pthread_cond_wait(ptr @pool.wake, ptr @pool.mutex)
  br label %sleep
rise:
  %d = atomicrmw sub ptr @pool.sleepers, i64 1 seq_cst
  %e = call i32 @pthread_mutex_unlock(ptr @pool.mutex)
  br label %rested
rested:
  br label %look
out:
  ret void
}"""

_CLOSE = """define void @pool.close() #0 {
  %a = call i32 @pthread_mutex_lock(ptr @pool.mutex)
  store atomic i64 1, ptr @pool.closing seq_cst, align 8
  %b = call i32 @pthread_cond_broadcast(ptr @pool.wake)
  %c = call i32 @pthread_mutex_unlock(ptr @pool.mutex)
  ret void
}"""
