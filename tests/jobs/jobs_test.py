"""The job scripts of docs/jobs, run by Slurm and by GNU parallel: a share that is killed in the
middle is run again, and the merged shares are the study that one run stores."""
import getpass
import os
import pathlib
import socket
import sqlite3
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = os.environ["TAPSTUDY_PROGRAM"]
ROOT = pathlib.Path(__file__).resolve().parents[2]
STUDY = ["simulate", str(ROOT / "protocols/paper/reality_finger.yaml"), "--participants", "8",
         "--seed", "3", "--no-traces"]
SHARES = 4
# Runs tapstudy. The first time that it runs share 2, it is killed as soon as its store is there.
KILLED_ONCE = r"""#!/bin/bash
for out; do :; done  # the last argument
if [[ $out != */share-2 ]] || ! mkdir "$0.has_killed" 2>/dev/null; then exec "$PROGRAM" "$@"; fi
status=0
until [ $status = 137 ]; do
  rm -rf "$out"
  "$PROGRAM" "$@" &
  until compgen -G "$out.unfinished-*/study.db" || ! kill -0 $!; do :; done >/dev/null 2>&1
  kill -9 $!
  wait $!
  status=$?
done 2>/dev/null
exit 1
"""


def run(*command, **options):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True,
                          check=False, **options)


def rows(directory):
    """All that was stored of each participant, but for ids and dates."""
    with sqlite3.connect(directory / "study.db") as database:
        return [database.execute(query).fetchall() for query in (
            "SELECT participant.*, seed, planned_order FROM participant JOIN session "
            "USING (participant_id) ORDER BY participant_index",
            "SELECT participant_index, number, position, alternative.label, alternative.stimulus, "
            "is_comparison FROM trial JOIN session USING (session_id) JOIN participant USING "
            "(participant_id) JOIN alternative USING (trial_id) ORDER BY 1, 2, 3",
            "SELECT participant_index, number, attempt, block, status, duration_s, response, "
            "is_correct, response_time_s, ticks, kind, t_s, value FROM trial JOIN session USING "
            "(session_id) JOIN participant USING (participant_id) JOIN response USING (trial_id) "
            "JOIN tick_statistics USING (trial_id) JOIN event USING (trial_id) "
            "ORDER BY 1, 2, 3, event.rowid")]


class Loopback:
    """A cluster of two nodes with one processor each, all of it on this machine."""

    def __init__(self, directory):
        ports = []
        for _ in range(3):
            with socket.socket() as free:
                free.bind(("127.0.0.1", 0))
                ports.append(free.getsockname()[1])
        conf = directory / "slurm.conf"
        for folder in ("state", "a", "b"):
            (directory / folder).mkdir()
        conf.write_text(f"""
ClusterName=loopback
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort={ports[0]}
AuthType=auth/none
CredType=cred/none
SlurmUser={getpass.getuser()}
SlurmdUser={getpass.getuser()}
StateSaveLocation={directory}/state
SlurmdSpoolDir={directory}/%n
SlurmctldPidFile={directory}/slurmctld.pid
SlurmdPidFile={directory}/slurmd-%n.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SwitchType=switch/none
SelectType=select/linear
NodeName=a NodeHostname=localhost NodeAddr=127.0.0.1 Port={ports[1]} CPUs=1
NodeName=b NodeHostname=localhost NodeAddr=127.0.0.1 Port={ports[2]} CPUs=1
PartitionName=all Nodes=a,b Default=YES
""")
        self.environment = {**os.environ, "SLURM_CONF": str(conf)}
        self.log = open(directory / "log", "w", encoding="utf-8")
        self.daemons = [
            subprocess.Popen(command, env=self.environment, stdout=self.log, stderr=self.log)
            for command in (["slurmctld", "-D"], ["slurmd", "-D", "-N", "a"],
                            ["slurmd", "-D", "-N", "b"])]

    def __enter__(self):
        while " is UP" not in run("scontrol", "ping", env=self.environment).stdout:
            if any(daemon.poll() is not None for daemon in self.daemons):
                raise RuntimeError(pathlib.Path(self.log.name).read_text(encoding="utf-8"))
            time.sleep(0.05)
        return self.environment

    def __exit__(self, *_):
        for daemon in reversed(self.daemons):
            daemon.terminate()
            daemon.wait()
        self.log.close()


class Jobs(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.directory = pathlib.Path(scratch.name)
        self.out = self.directory / "shares"
        self.killer = self.directory / "tapstudy_killed_once"
        self.killer.write_text(KILLED_ONCE)
        self.killer.chmod(0o755)
        self.environment = {**os.environ, "PROGRAM": PROGRAM, "TAPSTUDY": str(self.killer)}

    def merge(self):
        return run(PROGRAM, "merge", *sorted(self.out.glob("share-?")), "--out",
                   self.directory / "whole")

    def check_is_one_run(self):
        self.assertTrue(self.killer.with_name(self.killer.name + ".has_killed").exists())
        self.assertEqual(self.merge().returncode, 0)
        self.assertEqual(sorted(path.name for path in self.out.glob("share-*")),
                         [f"share-{i + 1}" for i in range(SHARES)])
        one = self.directory / "one"
        self.assertEqual(run(PROGRAM, *STUDY, "--out", one).returncode, 0)
        self.assertGreater(len(rows(one)[2]), 100)
        self.assertEqual(rows(self.directory / "whole"), rows(one))

    def test_slurm(self):
        with Loopback(self.directory) as environment:
            def send():
                return run("sbatch", "--wait", f"--array=1-{SHARES}", f"--output={os.devnull}",
                           ROOT / "docs/jobs/slurm_array.sh", SHARES, self.out, *STUDY,
                           env={**self.environment, "SLURM_CONF": environment["SLURM_CONF"]})
            self.assertNotEqual(send().returncode, 0)
            refused = self.merge()
            self.assertEqual(refused.returncode, 2)
            self.assertIn("share 2/4 is not among", refused.stderr)
            self.assertEqual(send().returncode, 0)
        self.check_is_one_run()

    def test_parallel(self):
        done = run(ROOT / "docs/jobs/gnu_parallel.sh", SHARES, self.out, *STUDY,
                   env=self.environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.check_is_one_run()


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + [f"Jobs.test_{name}" for name in sys.argv[1:]])
