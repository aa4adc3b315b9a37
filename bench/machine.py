# SPDX-License-Identifier: Apache-2.0
"""What the benchmarks share: this machine, what a command takes on it, and where results go."""

import json
import os
import platform
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "bench/results"
PROGRAMS = ROOT / "build/bin"


def fail(message):
    sys.exit(f"{Path(sys.argv[0]).name}: {message}")


def machine():
    facts = {}
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        name, _, value = line.partition(":")
        facts.setdefault(name.strip(), value.strip())
    model = facts.get("model name", "unknown")
    flags = facts.get("flags", "").split()
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    return {"name": re.sub(r"[^a-z0-9]+", "-", f"{model} {os.cpu_count()}".lower()).strip("-"),
            "cpu": model, "family": f"{facts.get('cpu family')}, model {facts.get('model')}",
            "processors": os.cpu_count(),
            "instructions": next((name for name in ("avx512f", "avx2", "sse4_2") if name in flags), "unknown"),
            "memory": f"{memory / 2**30:.0f} GiB", "system": platform.platform()}


def measured(command):
    """Runs the command; its standard output, its standard error, and what it used (getrusage)."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=out, stderr=err)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        err.seek(0)
        texts = out.read().decode(errors="replace"), err.read().decode(errors="replace")
    if child.returncode != 0:
        fail(f"{' '.join(map(str, command))} failed:\n{texts[1][-2000:]}")
    return *texts, usage


def write_results(path, **content):
    """Writes what was measured on this machine; says where."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({"version": 1, "machine": machine(), **content}, indent=1) + "\n")
    print(f"\n{path}")


def usual_results(kind):
    return RESULTS / f"{kind}-{machine()['name']}.json"
