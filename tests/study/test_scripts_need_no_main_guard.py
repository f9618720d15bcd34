"""A script without `if __name__ == "__main__"` may ask for worker processes: it is not run again in them."""

import subprocess
import sys

SCRIPT = """
import intermit
from intermit.study.pool import executor_of

print("begun")
with executor_of({workers}) as executor:
    work = map if executor is None else executor.map
    print(sum(work(abs, range(-5, 0))))
"""


def run(tmp_path, text):
    file = tmp_path / "script.py"
    file.write_text(text)
    return subprocess.run([sys.executable, file], capture_output=True, text=True, check=False, timeout=120)


def test_a_pool_does_not_run_the_script_again(tmp_path):
    for workers in (1, 2):
        done = run(tmp_path, SCRIPT.format(workers=workers))
        assert (done.returncode, done.stdout, done.stderr) == (0, "begun\n15\n", "")


def test_without_the_pools_care_the_script_would_fail(tmp_path):
    """The must-fail partner: the same work through a plain spawning executor."""
    plain = SCRIPT.format(workers=2).replace(
        "executor_of(2)",
        "__import__('concurrent.futures').futures.ProcessPoolExecutor("
        "2, mp_context=__import__('multiprocessing').get_context('spawn'))",
    )
    assert run(tmp_path, plain).returncode != 0
