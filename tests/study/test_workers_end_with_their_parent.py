"""A parent that is killed takes its workers along: none goes on computing for nobody."""

import os
import signal
import subprocess
import sys
import time

SCRIPT = """
import time
from multiprocessing import active_children
from intermit.study.pool import executor_of
with executor_of(2) as executor:
    jobs = [executor.submit(time.sleep, 300) for _ in range(2)]
    while not all(job.running() for job in jobs):
        time.sleep(0.05)
    time.sleep(1.0)
    print(*(child.pid for child in active_children()), flush=True)
    time.sleep(300)
"""
PATIENCE = 20
"""s; an idle machine takes less than one."""


def is_running(pid):
    try:
        with open(f"/proc/{pid}/stat") as stat:
            return stat.read().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


def test_workers_of_a_killed_parent_end():
    parent = subprocess.Popen([sys.executable, "-c", SCRIPT], stdout=subprocess.PIPE, text=True)
    try:
        workers = [int(pid) for pid in parent.stdout.readline().split()]
        assert len(workers) == 2
        assert all(is_running(pid) for pid in workers)
        os.kill(parent.pid, signal.SIGKILL)
        parent.wait()
        deadline = time.monotonic() + PATIENCE
        while any(is_running(pid) for pid in workers) and time.monotonic() < deadline:
            time.sleep(0.1)
        assert not any(is_running(pid) for pid in workers)
    finally:
        parent.kill()
        parent.stdout.close()
