"""Reports of several kinds in Chromium: axe-core, wide and narrow, light and dark, and as they are printed."""
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import browser
from program import PROGRAM, SOURCE

A4_PX = 673  # between usual margins, at 96 px an inch

ANSWERS = "participant,stimulus,response\n" + "".join(
    f"{person},{stimulus},{'ab'[(person + i) % 2] if person % 3 == 0 else stimulus}\n"
    for person in range(6) for i, stimulus in enumerate("abab"))


def sideways_tables(driver):
    """Those that a phone does not show without scrolling sideways in them; matrices of many are wide."""
    return driver.execute_script("""
        return [...document.querySelectorAll('.scroll:has(.data)')]
          .filter((box) => box.scrollWidth > box.clientWidth + 1).map((box) => box.ariaLabel)""")


def cut_tables(driver):
    return driver.execute_script("""
        return [...document.querySelectorAll(".scroll")].filter((one) => one.scrollWidth > one.clientWidth + 1)
          .map((one) => `${one.ariaLabel}: ${one.scrollWidth} px of ${one.clientWidth}`)""")


class Report(unittest.TestCase):
    def setUp(self):
        self.directory = Path(tempfile.mkdtemp(prefix="tapstudy_report_"))
        self.driver = browser.start_browser(has_webgl=False)
        self.addCleanup(self.driver.quit)

    def run_program(self, *options):
        subprocess.run([PROGRAM, *map(str, options)], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def check_citations(self):
        """Whoever is cited stands in the list of references."""
        said = self.driver.execute_script("""
            const page = document.querySelector("main").cloneNode(true);
            for (const one of page.querySelectorAll(".references, .notes, .provenance, h1, .simulated")) one.remove();
            return page.textContent""")
        listed = self.driver.execute_script("return document.querySelector('.references')?.textContent ?? ''")
        for author, year in re.findall(r"([A-Z][\w-]+)(?: (?:&|and) [A-Z][\w-]+(?: [A-Z][\w-]+)?| et al\.)? \(?((?:19|20)\d\d)\b", said):
            self.assertRegex(listed, rf"{author}[^\n]*\({year}\)", f"{author} {year} is cited, and not listed")

    def check(self, report):
        self.driver.get((report / "report.html").as_uri())
        self.driver.execute_script("for (const one of document.querySelectorAll('details')) one.open = true")
        self.check_citations()
        for width, height in ((1280, 800), (375, 812)):
            browser.set_size(self.driver, width, height)
            for is_dark in (False, True):
                browser.set_dark(self.driver, is_dark)
                with self.subTest(report=report.name, width=width, dark=is_dark):
                    browser.check_axe(self.driver)
                    browser.check_no_sideways_scrolling(self.driver)
                    if width == 375:
                        self.assertEqual(sideways_tables(self.driver), [])
        browser.set_size(self.driver, A4_PX, 1000)
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
        with self.subTest(report=report.name, printed=True):
            self.assertEqual(cut_tables(self.driver), [])
            browser.check_no_sideways_scrolling(self.driver)
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})

    def test_of_studies(self):
        for study in ("tests/data/material_study.yaml", "tests/data/every_task.yaml", "protocols/paper/reality_vibration.yaml"):
            directory = self.directory / Path(study).stem
            self.run_program("simulate", SOURCE / study, "--participants", 3, "--seed", 4, "--out", directory)
            self.run_program("report", directory)
            self.check(directory / "report")

    def check_contents(self):
        """Each of the links leads to its part, which is open then."""
        links = self.driver.find_elements("css selector", ".contents a")
        self.assertGreater(len(links), 5)
        for link in links:
            link.click()
            target = self.driver.find_element("id", link.get_attribute("href").split("#")[1])
            is_open, top = self.driver.execute_script(
                "const around = arguments[0].closest('details'); return [!around || around.open, arguments[0].getBoundingClientRect().top]", target)
            self.assertTrue(is_open, link.text)
            self.assertLess(top, self.driver.execute_script("return innerHeight"), link.text)

    def test_of_contents(self):
        self.run_program("simulate", SOURCE / "protocols/paper/discrimination.yaml", "--participants", 10, "--out", self.directory / "demo")
        self.run_program("report", self.directory / "demo")
        self.driver.get((self.directory / "demo/report/report.html").as_uri())
        self.assertLessEqual(self.driver.execute_script("return document.documentElement.scrollHeight / innerHeight"), 4)
        self.assertLess(self.driver.execute_script("return document.querySelector('.matrix').getBoundingClientRect().bottom"), 800)
        self.check_contents()

    def test_of_counts(self):
        (self.directory / "answers.csv").write_text(ANSWERS)
        self.run_program("report", "--counts", self.directory / "answers.csv", "--out", self.directory / "counts")
        self.check(self.directory / "counts")

    def test_of_names_that_are_markup(self):
        name = "<img src=x onerror=document.title='run'><script>document.title='run'</script>"
        (self.directory / "answers.csv").write_text(ANSWERS.replace(",b", "," + name))
        self.run_program("report", "--counts", self.directory / "answers.csv", "--out", self.directory / "markup")
        self.driver.get((self.directory / "markup" / "report.html").as_uri())
        self.assertEqual(self.driver.find_elements("css selector", "main script, main img[src=x]"), [])
        self.assertEqual(self.driver.title, "answers")
        self.assertIn(name, self.driver.execute_script("return document.querySelector('main').textContent"))


if __name__ == "__main__":
    unittest.main()
