"""Whole sessions in a browser, by a participant and an operator; a class of them by its name."""
import os
import re
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import browser
from program import PROGRAM, SOURCE, Session

SHOTS = os.environ.get("TAPSTUDY_SHOTS")
DISCRIMINATION = ["acrylic_two", "mdf_two", "acrylic_three", "mdf_three"]


class WholeSession(unittest.TestCase):
    def start(self, protocol, *options, width=1280, height=800, **look):
        self.session = Session(protocol, *options)
        self.addCleanup(self.session.close)
        self.driver = browser.start_browser(width, height, **look)
        self.addCleanup(self.driver.quit)
        browser.open_participant(self.driver, self.session.participant)

    def watch(self):
        self.operator = browser.start_browser(820, 1180, has_webgl=False)
        self.addCleanup(self.operator.quit)
        browser.open_operator(self.operator, self.session.operator)

    def shoot(self, name, driver=None):
        if SHOTS:
            browser.screenshot(driver or self.driver, Path(SHOTS) / f"{name}.png")

    def check_screen(self, name):
        browser.check_no_sideways_scrolling(self.driver)
        browser.check_axe(self.driver, ("serious", "critical"))
        self.shoot(name)

    def contacts(self):
        found = re.search(r"\d+", browser.find(self.operator, "#contacts").text)
        return int(found.group()) if found else 0

    def wait_for_touch(self, contacts=2):
        """So often from now on, by the simulated hand; an answer before is refused."""
        before = self.contacts()
        browser.wait_until(self.operator, f"{contacts} contacts",
                           lambda: self.contacts() >= before + contacts)

    def next_trial(self, number):
        """Read at one moment: a press on a screen that has not settled does nothing."""
        def there():
            screen = browser.current_screen(self.driver)
            is_there = screen and screen["kind"] == "trial" and screen["isSettled"]
            counts = [int(text) for text in re.findall(r"\d+", screen["progress"])] if is_there else []
            return screen if counts and min(counts) + 1 == number else None  # "1 of 8", or "8 中 1"
        return browser.wait_until(self.driver, f"trial {number}", there)

    def answer_until_accepted(self, answer, index, tap=lambda: None):
        """As a person does who is told to tap first."""
        screen = browser.current_screen(self.driver)
        answer(self.driver, index)

        def moved_on():
            now = browser.current_screen(self.driver)
            if now and now["kind"] == "trial" and now["status"] and not now["isBusy"] and \
                    now["progress"] == screen["progress"]:
                tap()
                answer(self.driver, index)
                return False
            return now and (now["kind"] != "trial" or now["progress"] != screen["progress"])
        browser.wait_until(self.driver, "the next screen", moved_on)

    def operate(self, by_keyboard):
        """A note, a pause and its end: the trial begins again."""
        browser.wait_for_state(self.operator, "exploring", "answering")
        command = browser.command_by_keyboard if by_keyboard else browser.command
        note = browser.write_note_by_keyboard if by_keyboard else browser.write_note
        note(self.operator, "the participant coughed")
        command(self.operator, "pause")
        browser.wait_for_screen(self.driver, "paused")
        browser.wait_for_state(self.operator, "paused")
        command(self.operator, "resume")
        browser.wait_for_screen(self.driver, "trial")

    def check_operated(self):
        self.assertEqual(self.session.rows("SELECT action FROM operator_action ORDER BY action_id"),
                         [("note",), ("pause",), ("resume",)])

    def finish(self):
        browser.wait_for_screen(self.driver, "ended")
        self.assertEqual(self.session.wait(), 0, self.session.said())


class Discrimination(WholeSession):
    def test_discrimination_by_mouse(self):
        self.identify_all(by_keyboard=False)

    def test_discrimination_by_keyboard_in_japanese_on_a_4k_screen(self):
        self.identify_all(True, "--language", "ja", width=3840, height=2160)

    def identify_all(self, by_keyboard, *options, **look):
        self.start("protocols/paper/discrimination.yaml", *options, **look)
        self.watch()
        answer = browser.answer_by_keyboard if by_keyboard else browser.answer_by_mouse
        given = []
        for number in range(1, 9):
            self.next_trial(number)
            browser.check_no_sideways_scrolling(self.driver)
            if number == 1:
                self.assertEqual(browser.wait_for_view(self.driver), "canvas")
                browser.check_axe(self.driver, ("serious", "critical"))
            if number == 2:
                self.shoot(f"participant_{look.get('width', 1280)}")
            if number == 3:
                self.operate(by_keyboard)
                self.next_trial(number)
            self.answer_until_accepted(answer, number % 4)
            given.append(DISCRIMINATION[number % 4])
        self.finish()
        self.assertEqual(self.session.responses(), given)
        self.check_operated()
        # 409: what was sent for a screen that the operator has just replaced
        browser.check_browser_log_is_empty(self.driver, but_for=("events", "ERR_", "409"))


class Reality(WholeSession):
    def choose(self, by_keyboard):
        feel = browser.feel_by_keyboard if by_keyboard else browser.feel_by_mouse
        answer = browser.answer_by_keyboard if by_keyboard else browser.answer_by_mouse
        screen = browser.wait_for_screen(self.driver, "trial")
        browser.check_no_sideways_scrolling(self.driver)
        count = len(screen["alternatives"])

        def feel_all():
            for alternative in range(count):
                feel(self.driver, alternative)
                self.wait_for_touch()
        feel_all()
        self.answer_until_accepted(answer, count - 1, feel_all)

    def finish_choices(self, by_keyboard):
        browser.wait_for_screen(self.driver, "trial")
        self.operate(by_keyboard)
        while browser.wait_for_screen(self.driver, "trial", "ended")["kind"] == "trial":
            self.choose(by_keyboard)
        self.finish()
        chosen = self.session.rows(
            "SELECT response = (SELECT stimulus FROM alternative WHERE alternative.trial_id = "
            "trial.trial_id ORDER BY position DESC LIMIT 1) FROM current_response "
            "JOIN trial USING (trial_id) WHERE status = 'answered'")
        self.check_operated()
        self.assertTrue(chosen)
        self.assertEqual({row[0] for row in chosen}, {1})  # the last label, whatever it stood for

    def test_reality_of_vibration_by_keyboard_on_a_phone_in_german(self):
        self.start("protocols/paper/reality_vibration.yaml", "--language", "de", width=375, height=700)
        self.watch()
        self.finish_choices(by_keyboard=True)

    def test_reality_of_vibration_by_mouse_on_a_4k_screen(self):
        self.start("protocols/paper/reality_vibration.yaml", width=3840, height=2160)
        self.watch()
        self.finish_choices(by_keyboard=False)

    def test_reality_at_the_finger_by_keyboard_on_a_phone_in_german(self):
        self.start("protocols/paper/reality_finger.yaml", "--language", "de", width=375, height=700)
        self.watch()
        self.finish_choices(by_keyboard=True)

    def test_reality_at_the_finger_by_mouse_in_japanese_without_webgl(self):
        self.start("protocols/paper/reality_finger.yaml", "--language", "ja", has_webgl=False)
        self.watch()
        self.assertEqual(browser.wait_for_view(self.driver), "svg")
        self.finish_choices(by_keyboard=False)


class EveryTask(WholeSession):
    def give_number(self, number, by_keys):
        """After what is none; the answer of the trial before is corrected where that may be."""
        for nonsense in ("0", "1.2.3", "1" * 30):
            (browser.answer_number_by_keyboard if by_keys else browser.answer_number_by_mouse)(self.driver, nonsense)
            browser.wait_for_status(self.driver, "a number above 0")
        if browser.find_all(self.driver, ".previous #number-correction"):
            browser.find(self.driver, ".previous summary").click()
            browser.find(self.driver, "#number-correction").send_keys("13.5")
            browser.find(self.driver, ".previous button").click()
            browser.wait_for_status(self.driver, "is corrected")
        self.answer_until_accepted(
            browser.answer_number_by_keyboard if by_keys else browser.answer_number_by_mouse, "12.5")

    def adjust(self, by_keys):
        """To the highest of 13 settings, and one back; dials are wheels of a mouse or keys of a keyboard."""
        up = lambda: browser.press(self.driver, browser.Keys.ARROW_UP) if by_keys else browser.turn_wheel(self.driver, ".moves", 1)
        if by_keys:
            browser.press_volume_up(self.driver)
        else:
            browser.move_by_mouse(self.driver, 1)
        for _ in range(12):
            up()
        browser.wait_for_status(self.driver, "B is at its limit in that direction")
        browser.wait_until(self.driver, "B to be felt", lambda: browser.current_screen(self.driver)["felt"] == 1)
        if by_keys:
            browser.press(self.driver, "-")
        else:
            browser.move_by_mouse(self.driver, -1)
        confirm = lambda driver, _: browser.press(driver, browser.Keys.ENTER) if by_keys else browser.find(driver, "#confirm").click()
        self.answer_until_accepted(confirm, None)

    def mark_line(self, by_keys):
        """To the right of the middle by arrows, left of it by mouse; the first is corrected to the left end."""
        if browser.find_all(self.driver, ".previous input[type=range]"):
            browser.find(self.driver, ".previous summary").click()
            browser.find(self.driver, ".previous input[type=range]").send_keys(browser.Keys.HOME)
            browser.find(self.driver, ".previous > button").click()
            browser.wait_for_status(self.driver, "is corrected")
        browser.find(self.driver, "#confirm").click()
        browser.wait_for_status(self.driver, "mark the line first")
        if by_keys:
            browser.find(self.driver, "h1").click()
            browser.press(self.driver, browser.Keys.ARROW_RIGHT, browser.Keys.ARROW_RIGHT)
        else:
            browser.click_at(self.driver, browser.find(self.driver, ".trial > fieldset input[type=range]"), 0.25)
        self.check_screen("line")
        self.answer_until_accepted(lambda driver, _: browser.find(driver, "#confirm").click(), None)

    def rank(self, by_keys):
        """C A B by keys, C B A by mouse after a change of mind; the first is corrected to B C A."""
        def press(labels, within=".trial > fieldset"):
            for label in labels:
                browser.find_all(self.driver, f"{within} .in-order")["ABC".index(label)].click()
        if browser.find_all(self.driver, ".previous .in-order"):
            browser.find(self.driver, ".previous summary").click()
            press("BCA", ".previous")
            self.check_screen("ranking_corrected")
            browser.find(self.driver, ".previous > button").click()
            browser.wait_for_status(self.driver, "is corrected")
        if by_keys:
            browser.press(self.driver, "3", "1")
            browser.press(self.driver, browser.Keys.ENTER)
            browser.wait_for_status(self.driver, "put all of them in order")
            self.check_screen("ranking")
            browser.press(self.driver, "2")
        else:
            press("CABAA")
        confirm = lambda driver, _: browser.press(driver, browser.Keys.ENTER) if by_keys else browser.find(driver, "#confirm").click()
        self.answer_until_accepted(confirm, None)

    def test_every_task_is_answered_by_mouse_and_by_keyboard(self):
        self.start("tests/data/every_task.yaml", width=375, height=800)
        alternatives = {"comparison": 2, "same_different": 2, "odd_one_out": 3, "abx": 3, "match_to_sample": 4, "adjustment": 14,
                        "paired": 2, "paired_or_tied": 2, "ranking": 3, "with_modulus": 2}
        shown = set()
        for number in range(1, 40):
            screen = self.next_trial(number)
            feels = browser.find_all(self.driver, ".feel")
            by_keys = number % 2 == 0
            for index in range(len(feels)):
                (browser.feel_by_keyboard if by_keys else browser.feel_by_mouse)(self.driver, index)
            if len(feels) not in shown or not feels or number > 37:
                self.check_screen(f"task_{number}")
                shown.add(len(feels))
            if browser.has_number_field(self.driver):
                self.give_number(number, by_keys)
            elif browser.find_all(self.driver, ".move"):
                self.check_screen(f"adjustment_{number}")
                self.adjust(by_keys)
            elif browser.find_all(self.driver, ".trial > fieldset .in-order"):
                self.rank(by_keys)
            elif browser.find_all(self.driver, ".trial > fieldset input[type=range]"):
                self.mark_line(by_keys)
            else:
                has_tie = screen["options"][-1:] == ["no difference"]
                self.answer_until_accepted(browser.answer_by_keyboard if by_keys else browser.answer_by_mouse, 2 if has_tie else 0)
        self.finish()
        counted = dict(self.session.rows(
            "SELECT block, max(position) + 1 FROM alternative JOIN trial USING (trial_id) "
            "WHERE block NOT IN ('rating', 'line', 'magnitude') GROUP BY block"))
        self.assertEqual(counted, alternatives)
        answers = dict(self.session.rows(
            "SELECT block, group_concat(DISTINCT response) FROM response JOIN trial USING (trial_id) GROUP BY block"))
        self.assertEqual(answers["same_different"], "same")
        self.assertEqual(answers["abx"], "A")
        self.assertEqual(answers["match_to_sample"], "A")
        self.assertEqual(answers["adjustment"], "5.75")
        self.assertEqual(answers["magnitude"], "12.5,13.5")  # and its correction
        self.assertEqual(answers["with_modulus"], "12.5")
        self.assertEqual(answers["rating"], "1")
        self.assertEqual(answers["paired_or_tied"], "tie")
        marks = [float(row[0]) for row in self.session.rows(
            "SELECT response FROM response JOIN trial USING (trial_id) WHERE block = 'line' ORDER BY response_id")]
        self.assertEqual(marks[1], 0, marks)  # a correction
        self.assertEqual(max(marks), 0.52)
        self.assertAlmostEqual(sorted(marks)[1], 0.25, delta=0.04)
        wanted = [list(order) for order in ("CAB", "BCA", "CBA")]  # the first, its correction, the second
        ranked = self.session.rows("SELECT trial_id, response FROM response JOIN trial USING (trial_id) "
                                   "WHERE block = 'ranking' ORDER BY response.rowid")
        labels = [[self.session.rows(f"SELECT label FROM alternative WHERE trial_id = {trial} AND stimulus = '{name}'")[0][0]
                   for name in response.split()] for trial, response in ranked]
        self.assertEqual(sorted(labels), sorted(wanted))


class EveryScreen(WholeSession):
    def with_pictures(self):
        """every_screen.yaml with a drawing in its instructions, its form and beside a question, and photographs to choose from."""
        folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, folder)
        shutil.copy(SOURCE / "tests/data/plates.svg", folder)
        shutil.copy(SOURCE / "docs/pictures/participant.png", folder / "hand.png")
        drawing = "{file: plates.svg, text: Two plates}"
        text = (SOURCE / "tests/data/every_screen.yaml").read_text()
        for before, after in (
                ("finger:", f"instructions_picture: {drawing}\nfinger:"),
                ("needed to take part.\n", f"needed to take part.\n    picture: {drawing}\n"),
                ("max: 99,", f"max: 99, picture: {drawing},"),
                ("[left, right],", "[left, right], option_pictures: [{file: hand.png, text: A left hand}, {file: hand.png, text: A right hand}],")):
            self.assertIn(before, text)
            text = text.replace(before, after, 1)
        (folder / "study.yaml").write_text(text)
        return folder / "study.yaml"

    def check_pictures(self, *texts):
        """These are on the screen, as their text says, and none is broken or from elsewhere."""
        pictures = browser.wait_until(self.driver, "pictures", lambda: self.driver.execute_script("""
            const all = [...document.querySelectorAll("img")];
            return all.every((one) => one.complete) && all.map((one) => [one.alt, one.src.slice(0, 11), one.naturalWidth > 0, one.clientWidth > 40])"""))
        self.assertEqual(pictures, [[text, "data:image/", True, True] for text in texts])

    def test_every_screen_in_its_order(self):
        self.start(self.with_pictures(), is_dark=True)
        browser.wait_for_screen(self.driver, "instructions")
        self.check_pictures("Two plates")
        self.check_screen("instructions")
        browser.go_on_by_mouse(self.driver)
        browser.wait_for_screen(self.driver, "form")
        self.check_pictures("Two plates", "Two plates", "A left hand", "A right hand")
        browser.fill_in_by_mouse(self.driver, "hand", "right")
        browser.fill_in_by_mouse(self.driver, "age", "29,5")  # as where numbers have decimal commas
        glove = browser.find(self.driver, '.item[data-name="glove"]')
        self.assertFalse(glove.is_displayed())
        browser.fill_in_by_mouse(self.driver, "held", ["a hammer", "a glove"])
        self.assertTrue(glove.is_displayed())
        browser.send_form_by_mouse(self.driver)
        self.assertEqual(browser.current_screen(self.driver)["kind"], "form")  # it is to be answered now
        browser.fill_in_by_mouse(self.driver, "glove", "a thick one")
        self.check_screen("form")
        browser.send_form_by_mouse(self.driver)
        for index, is_right in ((0, True), (0, False)):
            browser.wait_for_screen(self.driver, "trial")
            self.answer_until_accepted(browser.answer_by_mouse, index)
            feedback = browser.wait_for_screen(self.driver, "feedback")
            self.assertEqual("with vibration" in feedback["text"], not is_right)
            browser.go_on_by_mouse(self.driver)
        browser.wait_for_screen(self.driver, "instructions")
        browser.go_on_by_mouse(self.driver)
        for trial in range(2):
            if trial == 1:
                browser.wait_for_screen(self.driver, "rest")
                browser.go_on_by_mouse(self.driver)
            browser.wait_for_screen(self.driver, "trial")
            self.assertRegex(browser.find(self.driver, "[role=timer]").text, "^([1-4]?[0-9]|50) s left to answer$")
            self.assertRegex(browser.find(self.driver, "#time-text").text, ["^0 min so far$", "^0 min so far, about 1 min left$"][trial])
            self.answer_until_accepted(browser.answer_by_mouse, trial)
            browser.wait_for_screen(self.driver, "confidence")
            browser.answer_by_mouse(self.driver, 2)
        browser.wait_for_screen(self.driver, "form")
        browser.fill_in_by_mouse(self.driver, "real", 4)
        browser.fill_in_by_mouse(self.driver, "clear", 0.75)
        self.driver.execute_script(
            "document.querySelector('.item[data-name=remarks] textarea').value = 'ü'.repeat(5001)")
        browser.send_form_by_mouse(self.driver)
        error = browser.wait_until(self.driver, "what is wrong with the text", lambda: browser.find(
            self.driver, '.item[data-name="remarks"] .error').text, 10)
        self.assertIn("5000", error)
        self.assertEqual(browser.current_screen(self.driver)["kind"], "form")
        browser.fill_in_by_mouse(self.driver, "remarks", "ü")
        browser.send_form_by_mouse(self.driver)
        self.finish()
        self.assertEqual(self.session.responses(), ["bare", "bare", "bare", "ringing"])
        self.assertEqual(self.session.rows(
            "SELECT confidence FROM response WHERE confidence IS NOT NULL"), [(3,), (3,)])
        answers = dict(self.session.rows("SELECT item, answer FROM form_answer"))
        self.assertAlmostEqual(float(answers.pop("clear")), 0.75, delta=0.02)
        self.assertEqual(answers, {"age": "29.5", "hand": "right", "held": "a glove;a hammer", "glove": "a thick one", "real": "4", "remarks": "ü"})

    def test_numbers_are_taken_as_people_write_them_but_no_thousand_as_a_fraction(self):
        typed = ["2,5", "2.5", "１２", "0,125", "1.000", "1,000", "1e3", ""]
        taken = {"en": ["2.5", "2.5", "12", "0.125", "1.000", None, None, None],
                 "de": ["2.5", "2.5", "12", "0.125", None, "1.000", None, None]}
        for language, expected in taken.items():
            with self.subTest(language):
                self.start("protocols/paper/discrimination.yaml", "--language", language)
                browser.wait_for_screen(self.driver, "trial")
                found = self.driver.execute_async_script("""
                    const [typed, done] = arguments;
                    import(new URL("typed_number.js", document.baseURI))
                      .then(({ typedNumber }) => done(typed.map((text) => typedNumber(text))));""", typed)
                self.assertEqual([number["text"] for number in found], expected)
                refused = found[expected.index(None)]["problem"]
                self.assertIn("1000", refused)

    def test_an_answer_is_changed_until_it_is_confirmed(self):
        self.start("protocols/paper/discrimination.yaml")
        self.watch()
        browser.wait_for_state(self.operator, "exploring")
        self.next_trial(1)
        self.wait_for_touch()
        browser.pick_by_mouse(self.driver, 2)
        browser.wait_for_state(self.operator, "answering")
        time.sleep(0.3)
        browser.pick_by_mouse(self.driver, 0)
        time.sleep(0.3)
        self.driver.refresh()  # nothing is picked any more
        browser.wait_for_screen(self.driver, "trial")
        time.sleep(0.5)
        self.answer_until_accepted(browser.answer_by_mouse, 1)
        self.next_trial(2)
        self.assertEqual(self.session.rows(
            "SELECT state, detail FROM session_event WHERE number = 1 AND state NOT IN ('ready', 'saved') "
            "ORDER BY t_s"),
            [("exploring", ""), ("answering", DISCRIMINATION[2]), ("answering", DISCRIMINATION[0]),
             ("answering", ""), ("answering", DISCRIMINATION[1]), ("confirmed", "")])
        self.session.type("end seen enough")
        browser.wait_for_screen(self.driver, "ended")

    def test_real_plates_are_mounted_and_the_last_answer_is_corrected(self):
        self.start("tests/data/material_study.yaml", "--language", "de", width=375, height=800)
        for index in (0, 1):
            self.next_trial(index + 1)
            self.answer_until_accepted(browser.answer_by_mouse, index)
        browser.wait_for_screen(self.driver, "message")
        self.assertIn("Die Übung ist vorbei", browser.text_of_page(self.driver))
        browser.go_on_by_mouse(self.driver)
        for index in (0, 1):
            browser.wait_for_screen(self.driver, "message")
            browser.wait_until(self.driver, "the plate is asked for",
                               lambda: self.session.said().count("mount the real plate") == index + 1)
            self.session.type("resume")
            self.next_trial(1 + index)  # of those that count: practice is over
            self.assertTrue(browser.find(self.driver, "#view").get_attribute("hidden"))
            browser.answer_by_mouse(self.driver, index)
        self.next_trial(3)
        self.assertFalse(browser.find_all(self.driver, ".previous"))  # of a block that allows none
        self.answer_until_accepted(browser.answer_by_mouse, 0)
        self.next_trial(4)
        browser.find(self.driver, ".previous summary").click()
        self.check_screen("correction")
        browser.find_all(self.driver, ".previous button")[1].click()
        browser.wait_for_status(self.driver, "Ihre letzte Antwort ist berichtigt")
        self.assertEqual(self.session.responses(),
                         ["soft_small", "hard_small", "soft_small", "hard_small", "acrylic"])
        for number in range(4, 8):
            self.next_trial(number)
            self.answer_until_accepted(browser.answer_by_mouse, 0)
        self.finish()

    def test_alternatives_come_by_themselves_and_once_more(self):
        study = Path(tempfile.mkdtemp(prefix="tapstudy_intervals_"))
        self.addCleanup(shutil.rmtree, study)
        text = (SOURCE / "tests/data/same_alternatives.yaml").read_text()
        before = text.split("blocks:\n")[0]
        (study / "study.yaml").write_text(before + """blocks:
  - name: triangle
    task: odd_one_out
    question: "Which is odd?"
    stimuli: [one, other]
    explore: {intervals: {seconds: 0.8, gap_seconds: 0.4, max_replays: 1}}
""")
        self.start(study / "study.yaml", width=375, height=800)
        phases = browser.record_go_signals(self.driver)

        def follow_until_over():
            browser.wait_until(self.driver, "the end of the intervals", lambda: phases()[-1][0] == "over")
        self.next_trial(1)
        browser.answer_by_keyboard(self.driver, 0)
        browser.wait_until(self.driver, "the first interval", phases)
        self.check_screen("interval")
        follow_until_over()
        self.check_screen("intervals_over")
        browser.find(self.driver, ".replay").click()
        browser.wait_until(self.driver, "the replay", lambda: phases()[-1][0] != "over")
        follow_until_over()
        self.assertFalse(browser.find(self.driver, ".replay").is_displayed())
        now = [words for state, words in phases() if state == "open"]
        self.assertEqual(now, ["Now tap A.", "Now tap B.", "Now tap C."] * 2)
        for number in range(1, 7):
            if number > 1:
                self.next_trial(number)
                follow_until_over()
            browser.answer_by_keyboard(self.driver, 1)
        self.finish()
        told = self.session.rows("SELECT kind, count(*) FROM event WHERE kind IN ('interval', 'interval_end', 'interval_replay') GROUP BY kind")
        self.assertEqual(dict(told), {"interval": 21, "interval_end": 21, "interval_replay": 1})

    def test_fixations_of_every_kind_are_drawn_if_the_protocol_shows_them(self):
        self.start("tests/data/adaptive_tracks.yaml", has_webgl=False)
        self.next_trial(1)
        self.assertEqual(browser.wait_for_view(self.driver), "svg")
        drawn = [mark.tag_name for mark in browser.find_all(self.driver, "#view .fixation")]
        self.assertEqual(drawn, ["circle", "circle", "rect", "rect"])  # disc, ball, side, box
        side = browser.find(self.driver, "#view rect.fixation")
        self.assertAlmostEqual(float(side.get_attribute("height")), 300, delta=1)  # mm, the whole side
        self.shoot("fixations")


class Interruption(WholeSession):
    def test_the_operator_pauses_corrects_and_ends(self):
        self.start("protocols/paper/discrimination.yaml")
        self.watch()
        browser.wait_for_state(self.operator, "exploring")
        browser.check_axe(self.operator, ("serious", "critical"))
        self.next_trial(1)
        self.wait_for_touch()
        self.assertRegex(browser.plot_in_words(self.operator, "interval"), r"now \d+\.\d\d ms, last 5 s: \d")
        self.shoot("operator", self.operator)
        self.answer_until_accepted(browser.answer_by_mouse, 0)
        self.next_trial(2)
        browser.correct_to(self.operator, 3)
        browser.wait_until(self.operator, "the correction",
                           lambda: self.session.responses() == [DISCRIMINATION[3]])
        browser.write_note(self.operator, "the participant coughed")
        browser.command(self.operator, "pause")
        browser.wait_for_screen(self.driver, "paused")
        browser.wait_for_state(self.operator, "paused")
        self.assertEqual(browser.operator_state(self.operator)["force"], "off")
        self.assertRegex(browser.find(self.operator, "#session").text, r"1 of 8 done · \d+ min so far")
        self.session.type("resume")
        self.next_trial(2)
        self.session.type("skip")
        browser.wait_for_screen(self.driver, "message")
        browser.go_on_by_mouse(self.driver)
        self.next_trial(3)
        browser.command_with_reason(self.operator, "end", "feels sick")
        browser.wait_for_screen(self.driver, "ended")
        self.assertEqual(self.session.wait(), 130)
        actions = [row[0] for row in self.session.rows(
            "SELECT action || ' ' || detail FROM operator_action ORDER BY action_id")]
        self.assertEqual(actions, ["correct mdf_three", "note the participant coughed", "pause ",
                                   "resume ", "skip ", "end feels sick"])
        self.assertEqual(self.session.rows("SELECT detail FROM session_event WHERE state = 'stopped'"),
                         [("feels sick",)])

    def test_the_operator_sees_the_noise_that_is_played(self):
        directory = Path(tempfile.mkdtemp(prefix="tapstudy_masked_"))
        self.addCleanup(shutil.rmtree, directory)
        source = Path(__file__).resolve().parents[2]
        study, rig = directory / "study.yaml", directory / "rig.yaml"
        study.write_text((source / "protocols/paper/discrimination.yaml").read_text() +
                         "\nmasking: {kind: pink, level_db_fs: -30, ramp_s: 0.1}\n")
        rig.write_text((source / "protocols/rigs/simulated_hand.yaml").read_text() +
                       '\naudio: {card: "null", gain_db: -5}\n')
        self.start(study, "--rig", str(rig))
        self.watch()
        browser.wait_for_state(self.operator, "exploring")
        machine = lambda: browser.operator_state(self.operator)["machine"]
        browser.wait_until(self.operator, "the noise", lambda: "playing, -35 dB FS" in machine())
        self.assertNotIn("not playing", machine())
        browser.command(self.operator, "pause")
        browser.wait_until(self.operator, "silence", lambda: "not playing, -35 dB FS" in machine())

    def test_a_page_that_vanishes_comes_back_to_the_same_question(self):
        self.start("protocols/paper/discrimination.yaml")
        self.next_trial(1)
        self.driver.get("about:blank")
        browser.open_participant(self.driver, self.session.participant)
        self.next_trial(1)
        self.answer_until_accepted(browser.answer_by_mouse, 1)
        self.next_trial(2)
        self.session.kill()
        browser.wait_until(self.driver, "the banner", lambda: browser.current_screen(self.driver)["banner"])
        self.session = Session("protocols/paper/discrimination.yaml", "--resume", directory=self.session.directory)
        self.addCleanup(self.session.close)
        browser.open_participant(self.driver, self.session.participant)
        self.next_trial(2)
        self.assertEqual(self.session.responses(), [DISCRIMINATION[1]])

    def test_adaptive_tracks_at_the_page_are_those_of_the_terminal_and_outlive_the_program(self):
        study = "tests/data/adaptive_tracks.yaml"
        picks = [0, 1, 1, 0, 0, 0, 1, 0, 1, 1]
        self.start(study, "--seed", "5")
        for number, pick in enumerate(picks, 1):
            self.next_trial(number)
            if number == 6:
                self.session.kill()
                self.session = Session(study, "--resume", directory=self.session.directory)
                self.addCleanup(self.session.close)
                browser.open_participant(self.driver, self.session.participant)
                self.next_trial(number)
            self.answer_until_accepted(browser.answer_by_keyboard if number % 2 else browser.answer_by_mouse, pick)
        self.finish()
        typed = Path(tempfile.mkdtemp(prefix="tapstudy_typed_"))
        self.addCleanup(shutil.rmtree, typed)
        subprocess.run([PROGRAM, "run", SOURCE / study, "--participant", "P01", "--seed", "5", "--out", typed / "study"],
                       input="".join(f"= {'AB'[pick]}\n" for pick in picks), text=True, capture_output=True, check=True)
        levels = ("SELECT number, value, response FROM axis_value JOIN alternative USING (trial_id, position) "
                  "JOIN trial USING (trial_id) JOIN current_response USING (trial_id) WHERE is_comparison ORDER BY number")
        at_terminal = sqlite3.connect(typed / "study" / "study.db").execute(levels).fetchall()
        self.assertEqual(len(at_terminal), 10)
        self.assertEqual(self.session.rows(levels), at_terminal)

    def test_a_browser_that_is_killed_pauses_the_session_and_loses_no_answer(self):
        self.start("protocols/paper/discrimination.yaml")
        self.next_trial(1)
        self.answer_until_accepted(browser.answer_by_mouse, 1)
        self.next_trial(2)
        os.kill(self.driver.capabilities["goog:processID"], signal.SIGKILL)
        self.wait_until_said("paused: ")
        self.driver = browser.start_browser()
        self.addCleanup(self.driver.quit)
        browser.open_participant(self.driver, self.session.participant)
        self.session.type("resume")
        for number in range(2, 9):
            self.next_trial(number)
            self.answer_until_accepted(browser.answer_by_mouse, 2)
        self.finish()
        self.assertEqual(self.session.responses(), [DISCRIMINATION[1]] + 7 * [DISCRIMINATION[2]])

    def wait_until_said(self, text):
        end = time.monotonic() + browser.PATIENCE_S
        while text not in self.session.said():
            self.assertLess(time.monotonic(), end, self.session.said())
            time.sleep(0.1)


if __name__ == "__main__":
    assert Path(PROGRAM).exists(), PROGRAM
    unittest.main(argv=sys.argv, verbosity=2)
