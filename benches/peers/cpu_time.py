"""CPU time of campaigns of spindrift, for comparisons with other programs."""

import resource
import subprocess


def campaign(spindrift, file, folder, samples):
    """CPU seconds of `file` with `samples` samples on one thread, without a page; rows go to `folder`/rows."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    options = f"--samples {samples} --threads 1 --no-report --overwrite --out".split()
    found = subprocess.run([spindrift, "campaign", file, *options, folder / "rows"], capture_output=True, text=True)
    # 3: a requirement is not met
    if found.returncode not in (0, 3):
        raise RuntimeError(found.stderr)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
