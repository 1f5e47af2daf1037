"""Studies of several sites on a real PostgreSQL server, which the tests start, cut off and kill."""
import json
import os
import pathlib
import pwd
import signal
import socket
import sqlite3
import subprocess
import sys
import tempfile
import threading
import time
import unittest

PROGRAM = os.environ["TAPSTUDY_PROGRAM"]
ROOT = pathlib.Path(__file__).resolve().parents[2]
STUDY = ROOT / "protocols/paper/reality_finger.yaml"
BINARIES = sorted(pathlib.Path("/usr/lib/postgresql").glob("*/bin"))[-1]
CERTIFICATE_NAME = "server.tapstudy.test"


def tapstudy(*words, **environment):
    return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, check=False,
                          env={**os.environ, **environment})


def simulate(directory, *, seed, participants=2, study=STUDY):
    done = tapstudy("simulate", study, "--participants", participants, "--seed", seed, "--out",
                    directory)
    assert done.returncode == 0, done.stderr


def rename_participants(directory, site):
    """Every simulation has the same ones."""
    with sqlite3.connect(directory / "study.db") as database:
        for table in ("participant", "session"):
            database.execute(f"UPDATE {table} SET participant_id = ? || participant_id", [site])


def stored(directory):
    """Every row of every table, with its number."""
    with sqlite3.connect(directory / "study.db") as database:
        tables = [name for name, in database.execute(
            "SELECT name FROM sqlite_schema WHERE type = 'table' ORDER BY name")]
        return {name: database.execute(f"SELECT rowid, * FROM {name} ORDER BY rowid").fetchall()
                for name in tables}


class Server:
    """A cluster of its own on a free port of the loopback; it never runs as root."""

    def __init__(self, directory):
        self.directory = directory
        directory.mkdir()
        self.user = {}
        if os.getuid() == 0:
            postgres = pwd.getpwnam("postgres")
            os.chown(directory, postgres.pw_uid, postgres.pw_gid)
            self.user = {"user": postgres.pw_uid, "group": postgres.pw_gid, "extra_groups": []}
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.call("initdb", "-D", directory / "data", "-A", "trust", "-U", "admin", "--no-sync",
                  "--locale=C", "--encoding=UTF8")
        with open(directory / "data/postgresql.conf", "a", encoding="utf-8") as conf:
            conf.write(f"port = {self.port}\nlisten_addresses = '127.0.0.1'\n"
                       f"unix_socket_directories = '{directory}'\n")
        self.start()
        self.sql(tapstudy("schema", "postgresql").stdout)
        self.sql("CREATE ROLE site LOGIN IN ROLE tapstudy_site;"
                 "CREATE ROLE reader LOGIN IN ROLE tapstudy_reader")

    def call(self, program, *words):
        done = subprocess.run([BINARIES / program, *map(str, words)], capture_output=True,
                              text=True, check=False, cwd="/", **self.user)
        if done.returncode != 0:
            raise RuntimeError(done.stdout + done.stderr)
        return done.stdout

    def start(self):
        self.call("pg_ctl", "-D", self.directory / "data", "-l", self.directory / "log", "-w",
                  "-t", "300", "start")

    def stop(self, how="fast"):
        self.call("pg_ctl", "-D", self.directory / "data", "-m", how, "-w", "-t", "300", "stop")

    def kill(self):
        """Every process at once, as when the machine loses its power."""
        processes = [int((self.directory / "data/postmaster.pid").read_text().split()[0])]
        processes += map(int, self.sql("SELECT pid FROM pg_stat_activity").split())
        for process in processes:
            try:
                os.kill(process, signal.SIGKILL)
            except ProcessLookupError:  # the one that answered the question
                pass
        for process in processes:
            while os.path.exists(f"/proc/{process}"):
                time.sleep(0.01)

    def url(self, user="site", port=None):
        return f"postgresql://{user}@127.0.0.1:{port or self.port}/postgres"

    def sql(self, text, user="admin"):
        return subprocess.run(["psql", "-qAt", "-v", "ON_ERROR_STOP=1", self.url(user)], input=text,
                              capture_output=True, text=True, check=user == "admin").stdout


class CutCable:
    """Passes a connection on until so many bytes have gone to the server, and then ends it."""

    def __init__(self, server, most, on_cut=lambda: None):
        self.server, self.most, self.on_cut, self.was_cut = server, most, on_cut, False
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.listener.settimeout(60)  # where nobody connects, nothing is cut, which fails
        self.port = self.listener.getsockname()[1]
        self.thread = threading.Thread(target=self.accept)
        self.thread.start()

    def accept(self):
        with (self.listener, self.listener.accept()[0] as client,
              socket.create_connection(("127.0.0.1", self.server.port)) as server):
            back = threading.Thread(target=self.pass_on, args=(server, client, None))
            back.start()
            self.pass_on(client, server, self.most)
            back.join()

    def pass_on(self, source, target, most):
        passed = 0
        try:
            while (data := source.recv(4096)) and (most is None or passed < most):
                target.sendall(data)
                passed += len(data)
        except OSError:
            pass
        if most is not None and passed >= most:
            self.was_cut = True
            self.on_cut()
        for end in (source, target):
            try:
                end.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass


class Sites(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.directory = pathlib.Path(scratch.name)
        self.directory.chmod(0o755)
        self.server = Server(self.directory / "server")
        self.addCleanup(self.server.stop, "immediate")

    def push(self, directory, site, url=None, **environment):
        return tapstudy("push", directory, url or self.server.url(), "--site", site, **environment)

    def pulled(self, out):
        done = tapstudy("pull", self.server.url("reader"), "--out", self.directory / out)
        self.assertEqual(done.returncode, 0, done.stderr)
        return [pathlib.Path(line).parent for line in done.stdout.splitlines()]

    def visible(self):
        return self.server.sql("SELECT count(*) FROM tapstudy.mirrored").strip()

    # What was cut off shows nothing, what had arrived is not sent again, and the next push ends it.
    def test_cut(self):
        study = self.directory / "kyoto"
        simulate(study, seed=1, participants=4)  # 10 MB, of which 4 are sent at once
        traces = len(stored(study)["trace_chunk"])
        for most, kill in ((2_000, False), (100_000, False), (6_500_000, False), (3_000_000, True)):
            cable = CutCable(self.server, most, self.server.kill if kill else lambda: None)
            cut = self.push(study, "kyoto", self.server.url(port=cable.port))
            cable.thread.join()
            self.assertTrue(cable.was_cut)
            self.assertEqual(cut.returncode, 5, cut.stderr)
            self.assertIn("postgresql://127.0.0.1/postgres", cut.stderr)
            if kill:
                self.server.start()
            self.assertEqual(self.visible(), "0")
        kept = int(self.server.sql("SELECT count(*) FROM tapstudy.trace_chunk"))
        self.assertGreater(kept, 0)
        self.assertLess(kept, traces)
        done = self.push(study, "kyoto")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual([stored(one) for one in self.pulled("once")], [stored(study)])
        again = self.push(study, "kyoto")
        self.assertTrue(again.stdout.startswith("0 of"), again.stdout + again.stderr)
        self.assertEqual([stored(one) for one in self.pulled("twice")], [stored(study)])

    # Two sites push at once; the server's report is that of both directories, to the byte.
    def test_report(self):
        sites = ["kyoto", "sapporo"]
        for seed, site in enumerate(sites):
            simulate(self.directory / site, seed=seed)
            rename_participants(self.directory / site, site)
        pushes = [subprocess.Popen([PROGRAM, "push", self.directory / site, self.server.url(),
                                    "--site", site], stdout=subprocess.DEVNULL) for site in sites]
        self.assertEqual([push.wait() for push in pushes], [0, 0])
        here, there = (self.directory / name for name in ("here", "there"))
        own = tapstudy("report", *(self.directory / site for site in sites), "--out", here)
        served = tapstudy("report", self.server.url("reader"), "--out", there)
        self.assertEqual((own.returncode, served.returncode), (0, 0), own.stderr + served.stderr)
        files = sorted(path.relative_to(here) for path in here.rglob("*") if path.is_file())
        self.assertGreater(len(files), 5)
        self.assertEqual(files,
                         sorted(path.relative_to(there) for path in there.rglob("*")
                                if path.is_file()))
        for file in files:
            self.assertEqual((here / file).read_bytes(), (there / file).read_bytes(), file)

    # However many ask at once, each participant has a row and keeps it, and no row is given twice.
    def test_rows(self):
        study = self.directory / "kyoto"
        simulate(study, seed=1)
        self.assertEqual(self.push(study, "kyoto").returncode, 0)
        who = [(site, f"{site}-{i}") for i in range(4) for site in ("kyoto", "sapporo", "oita")]

        def ask():
            asking = [subprocess.Popen(
                [PROGRAM, "schedule", STUDY, self.server.url(), "--site", site, "--participant",
                 person], stdout=subprocess.PIPE, text=True) for site, person in who]
            return [int(process.communicate()[0]) for process in asking]
        rows = ask()
        self.assertEqual(sorted(rows), list(range(1, len(who) + 1)))
        self.assertEqual(ask(), rows)
        namesake = tapstudy("schedule", STUDY, self.server.url(), "--site", "oita", "--participant",
                            "KYOTO-1")
        self.assertEqual(namesake.returncode, 5, namesake.stderr)
        self.assertIn("kyoto has a participant kyoto-1", namesake.stderr)
        changed = self.directory / "changed.yaml"
        changed.write_text(STUDY.read_text(encoding="utf-8") + "\n# changed\n", encoding="utf-8")
        refused = tapstudy("schedule", changed, self.server.url(), "--site", "oita",
                           "--participant", "P9")
        self.assertEqual(refused.returncode, 5, refused.stderr)
        self.assertIn("another text of the protocol", refused.stderr)

    # What no report could take together is refused by the push, and others see nothing of it.
    def test_namesakes(self):
        kyoto, tokyo = self.directory / "kyoto", self.directory / "tokyo"
        simulate(kyoto, seed=1)
        simulate(tokyo, seed=2)
        self.assertEqual(self.push(kyoto, "kyoto").returncode, 0)
        for directory, site, says in ((kyoto, "Kyoto", "kyoto has pushed the session of"),
                                      (tokyo, "tokyo", "redact --prefix tokyo")):
            refused = self.push(directory, site)
            self.assertEqual(refused.returncode, 5, refused.stdout)
            self.assertIn(says, refused.stderr)
        self.assertEqual(len(self.pulled("first")), 1)
        copy = self.directory / "copy"
        redacted = tapstudy("redact", tokyo, "--out", copy, "--prefix", "tokyo")
        self.assertEqual(redacted.returncode, 0, redacted.stderr)
        self.assertEqual(self.push(copy, "tokyo").returncode, 0)
        report = tapstudy("report", self.server.url("reader"), "--out", self.directory / "report")
        self.assertEqual(report.returncode, 0, report.stderr)
        written = json.loads((self.directory / "report/report.json").read_text(encoding="utf-8"))
        self.assertEqual(written["participants"], 4)

        changed = self.directory / "changed.yaml"
        changed.write_text(STUDY.read_text(encoding="utf-8") + "\n# changed\n", encoding="utf-8")
        simulate(self.directory / "oita", seed=3, study=changed)
        told = self.push(self.directory / "oita", "oita")
        self.assertEqual(told.returncode, 0, told.stderr)
        self.assertIn("another text of the protocol", told.stderr)

    # Rights, encryption, passwords, and studies that are not the one that was pushed before.
    def test_refused(self):
        study, other = self.directory / "kyoto", self.directory / "other"
        simulate(study, seed=1)
        self.assertEqual(self.push(study, "kyoto", self.server.url("reader")).returncode, 5)
        self.assertEqual(self.push(study, "kyoto").returncode, 0)
        for change in ("DELETE FROM tapstudy.response", "UPDATE tapstudy.response SET response = ''",
                       "UPDATE tapstudy.schema_version SET version = 0"):
            self.server.sql(change, user="site")
        self.assertEqual([stored(one) for one in self.pulled("kept")], [stored(study)])

        simulate(other, seed=2)
        with sqlite3.connect(study / "study.db") as database:
            created = database.execute("SELECT created_utc FROM study").fetchone()
        with sqlite3.connect(other / "study.db") as database:
            database.execute("UPDATE study SET created_utc = ?", created)
        refused = self.push(other, "kyoto")
        self.assertEqual(refused.returncode, 5)
        self.assertIn("differ from those that it was sent before", refused.stderr)

        self.server.sql("UPDATE tapstudy.response SET response = 'oak' WHERE row_id = 1")
        refused = tapstudy("pull", self.server.url(), "--out", self.directory / "changed")
        self.assertEqual(refused.returncode, 5)
        self.assertIn("are not those that were pushed", refused.stderr)
        self.assertFalse((self.directory / "changed").exists())

        named = f"postgresql://site@{CERTIFICATE_NAME}:{self.server.port}/postgres?hostaddr=127.0.0.1"
        for url, says in ((named, "SSL"), (named + "&sslmode=disable", "sslmode=disable"),
                          ("postgresql://site:secret@127.0.0.1/postgres", "PGPASSWORD"),
                          ("postgresql://site@127.0.0.1:1/postgres", "refused"),
                          ("mysql://site@127.0.0.1/x", "postgresql://USER@HOST/DATABASE")):
            with self.subTest(url=url):
                refused = self.push(study, "kyoto", url)
                self.assertIn(refused.returncode, (2, 5))
                self.assertIn(says, refused.stderr)
                self.assertNotIn("secret", refused.stderr)

        data = self.server.directory / "data"
        subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2",
                        "-subj", f"/CN={CERTIFICATE_NAME}", "-keyout", data / "server.key", "-out",
                        data / "server.crt"], check=True, capture_output=True)
        for file in (data / "server.key", data / "server.crt"):
            file.chmod(0o600)
            os.chown(file, self.server.user.get("user", -1), self.server.user.get("group", -1))
        root = self.directory / "root.crt"
        root.write_bytes((data / "server.crt").read_bytes())
        self.server.sql("ALTER SYSTEM SET ssl = on")
        self.server.stop()
        self.server.start()
        self.assertEqual(self.push(study, "kyoto", named, PGSSLROOTCERT=str(root)).returncode, 0)
        refused = self.push(study, "kyoto", named)  # nobody vouches for the certificate
        self.assertEqual(refused.returncode, 5)
        self.assertIn("certificate", refused.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + [f"Sites.test_{name}" for name in sys.argv[1:]])
