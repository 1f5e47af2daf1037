"""Every task with every procedure that it takes, answered at the terminal, at the page, and by a simulated participant.

The same answers to the same seed make the same session at the terminal and at the page: the same order, levels, responses. Prints one table.
A class of tasks by its name.
"""
import json
import shutil
import sqlite3
import subprocess
import tempfile
import unittest
from pathlib import Path
from urllib.parse import urlparse

from page_client import open_stream, post
from program import PROGRAM, SOURCE, Session

TASK_FILE = SOURCE / "tests/data/every_task.yaml"
GRID = "stimulus: {min: 0.1, max: 1.0, count: 10}, threshold: {min: 0.1, max: 1.0, count: 10}"
PROCEDURES = {
    "constant": "constant: {values: [0.5, 1.0], repetitions: 3}",
    "staircase": "staircase: {rule: transformed, n_down: 2, steps: linear, first_step: 0.4, min_step: 0.1, start: 0.8, min: 0.1, "
                 "max: 1.0, stop: {trials: 6}, estimate_reversals: 2}",
    "weighted": "staircase: {rule: weighted, target: 0.75, steps: linear, first_step: 0.3, min_step: 0.1, start: 0.8, min: 0.1, "
                "max: 1.0, stop: {trials: 6}, estimate_reversals: 2}",
    "quest_plus": "quest_plus: {function: weibull, " + GRID + ", slope: {values: [1, 3]}, guess: {values: [GUESS]}, lapse: "
                  "{values: [0.02]}, stop: {trials: 6}}",
    "psi": "psi: {function: weibull, " + GRID + ", slope: {values: [1, 3]}, guess: GUESS, lapse: 0.02, stop: {trials: 6}}",
}
# What the block says beside its name, task and question; the guess rate of tasks with procedures.
# Of tasks with procedures: the probability of a right guess.
VARIED = {"comparison": 0.5, "comparison, alternatives: 4": 0.25, "same_different": 0.5,
          "odd_one_out": 0.3333, "odd_one_out, alternatives: 4": 0.25, "abx": 0.5}
FIXED = {
    "identification": "stimuli: [one, other]",
    "choice": "stimuli: [one, other, third], repetitions: 3",
    "comparison": "stimuli: [other, one]",
    "same_different": "stimuli: [one, other]",
    "odd_one_out": "stimuli: [one, other], alternatives: 4",
    "abx": "stimuli: [one, other]",
    "match_to_sample": "stimuli: [one, other, third]",
    "paired": "stimuli: [one, other, third]",
    "paired, ties": "stimuli: [one, other], tie: no difference",
    "ranking": "stimuli: [one, other, third], repetitions: 2",
    "rating": "stimuli: [one, other], steps: 7, low: not at all, high: fully",
    "rating, line": "stimuli: [one, other], scale: visual_analogue, low: not at all, high: fully",
    "magnitude": "stimuli: [one, other]",
    "adjustment": "stimuli: [family], settings: {from: 3, to: 6, count: 13}, standard: 4.5, repetitions: 2",
}


def study_of(block):
    text = TASK_FILE.read_text()
    head, rest = text.split("blocks:\n")
    head = head.replace("  family:\n", "  third: {plate: held, material: mdf, technique: sinusoid, rendering: "
                                       "{sinusoid_amplitude_n_s_per_m: 5}}\n  family:\n")
    simulation = rest[rest.index("simulation:"):]
    if "reference" not in block:
        needs = any(f"task: {task}" in block for task in ("choice", "paired", "ranking", "rating"))
        simulation = simulation if needs else simulation.replace(", reference: one", "")
    return f"{head}blocks:\n  - {{name: main, question: \"Which?\", explore: {{min_contacts: 0}}, {block}}}\n{simulation}"


def ways():
    for task, says in FIXED.items():
        yield task, "fixed", f"task: {task.split(',')[0]}, {says}"
    for task, guess in VARIED.items():
        for procedure, says in PROCEDURES.items():
            yield task, procedure, f"task: {task}, stimuli: [family], procedures: [{{{says.replace('GUESS', str(guess))}}}]"


def choice_of(number, count):
    """From 0; the same at the terminal and at the page."""
    return (7 * number + 3) % 5 % count


class Answer:
    """What is answered to a trial's question, as a page sends it and as it is typed."""

    def __init__(self, number, answers, labels):
        kind, options = answers["kind"], answers["options"]
        if kind == "option":
            place = choice_of(number, len(options))
            self.value = str(place + 1)
            self.typed = self.value if options[0] not in labels else f"= {options[place] if options[place] in labels else place + 1}"
        elif kind == "number":
            self.value = self.typed = str(10 + choice_of(number, 5))
        elif kind == "line":
            self.value = self.typed = str(choice_of(number, 5) / 4)
        elif kind == "order":
            shift = choice_of(number, len(options))
            places = [(place + shift) % len(options) for place in range(len(options))]
            self.value = " ".join(str(place + 1) for place in places)
            self.typed = "= " + " ".join(options[place] for place in places)
        else:
            self.value = self.typed = None  # where the setting stands


class EveryWay(unittest.TestCase):
    def setUp(self):
        self.directory = Path(tempfile.mkdtemp(prefix="tapstudy_ways_"))
        self.addCleanup(shutil.rmtree, self.directory)

    def at_page(self, study):
        """The answers given, as typed."""
        session = Session(study, "--seed", "7", directory=self.directory / "page")
        self.addCleanup(session.close)
        typed = {}
        url = urlparse(session.participant)
        for screen in screens(url, session):
            if screen["kind"] == "ended":
                break
            if screen["kind"] != "trial":
                post(url, {"screen": screen["number"], "action": "go_on"})
                continue
            trial = screen["trial"]
            if trial["number"] in typed:
                continue  # what is on its way crossed the answer
            answer = Answer(trial["number"], trial["answers"], trial.get("alternatives") or [])
            value = answer.value or str(trial["setting"] + 1)
            if post(url, {"screen": screen["number"], "action": "answer", "value": value}) == 200:
                typed[trial["number"]] = answer.typed or "="
        self.assertEqual(session.wait(), 0, session.said())
        return list(typed.values())

    def at_terminal(self, study, typed):
        ran = subprocess.run([PROGRAM, "run", study, "--participant", "P01", "--seed", "7", "--out", self.directory / "terminal" / "study"],
                             input="\n".join(typed) + "\n", text=True, capture_output=True)
        self.assertEqual(ran.returncode, 0, ran.stderr)

    def stored(self, way):
        database = sqlite3.connect(self.directory / way / "study" / "study.db")
        query = ("SELECT number, response, is_correct, (SELECT group_concat(position || stimulus || coalesce(axis_values, ''), ' ') "
                 "FROM v_stimuli WHERE v_stimuli.trial_id = v_trials.trial_id) FROM v_trials WHERE status = 'answered' ORDER BY number")
        try:
            return database.execute(query).fetchall()
        finally:
            database.close()

    def go(self, chosen):
        print(f"\n{'task':<18}{'procedure':<12}{'trials':>6}  {'terminal':<10}{'page':<10}simulated")
        for task, procedure, block in chosen:
            with self.subTest(task=task, procedure=procedure):
                self.directory = Path(tempfile.mkdtemp(prefix="tapstudy_ways_"))
                self.addCleanup(shutil.rmtree, self.directory)
                for way in ("page", "terminal"):
                    (self.directory / way).mkdir()
                study = self.directory / "study.yaml"
                study.write_text(study_of(block))
                typed = self.at_page(study)
                self.at_terminal(study, typed)
                at_page, at_terminal = self.stored("page"), self.stored("terminal")
                self.assertTrue(at_page)
                self.assertEqual(at_page, at_terminal)
                self.simulate(study, len(at_page))
                print(f"{task:<18}{procedure:<12}{len(at_page):>6}  {'same':<10}{'same':<10}answered and reported")

    def simulate(self, study, trials):
        out = self.directory / "simulated" / "study"
        for command in (["simulate", study, "--participants", "2", "--seed", "3", "--out", out], ["report", out], ["verify", out]):
            ran = subprocess.run([PROGRAM, *command], text=True, capture_output=True)
            self.assertEqual(ran.returncode, 0, ran.stderr + ran.stdout)
        self.assertGreaterEqual(len(self.stored("simulated")), trials)


def varied(*tasks):
    return [way for way in ways() if way[1] != "fixed" and way[0].split(",")[0] in tasks]


class OfFixedStimuli(EveryWay):
    def test_at_the_terminal_at_the_page_and_simulated(self):
        self.go([way for way in ways() if way[1] == "fixed"])


class Comparison(EveryWay):
    def test_at_the_terminal_at_the_page_and_simulated(self):
        self.go(varied("comparison"))


class OddOneOut(EveryWay):
    def test_at_the_terminal_at_the_page_and_simulated(self):
        self.go(varied("odd_one_out"))


class OtherTasks(EveryWay):
    def test_at_the_terminal_at_the_page_and_simulated(self):
        self.go(varied(*{task.split(",")[0] for task in VARIED} - {"comparison", "odd_one_out"}))


def screens(url, session):
    """Each as it comes, until the program has gone."""
    text = b""
    with open_stream(url) as connection:
        connection.settimeout(60)
        while True:
            part = connection.recv(65536)
            if not part:
                return
            text += part
            while b"\n\n" in text:
                event, text = text.split(b"\n\n", 1)
                lines = event.decode().splitlines()
                if any(line.strip() == "event: screen" for line in lines):
                    yield json.loads("".join(line[5:] for line in lines if line.startswith("data:")))


if __name__ == "__main__":
    unittest.main(verbosity=1)
