"""Drives the two pages of a live session in Chromium, as people use them.

Knows only the pages' URLs. AXE_CORE in the environment names axe.min.js. Every wait ends with an error that says what was on the page.
"""
import os
import re
import time
from pathlib import Path

from selenium import webdriver
from selenium.common.exceptions import JavascriptException, StaleElementReferenceException
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.actions.wheel_input import ScrollOrigin
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select

PATIENCE_S = 60  # other tests run beside these; a wait that ends well is no longer for it
AXE = os.environ.get("AXE_CORE")


def start_browser(width=1280, height=800, is_dark=False, has_webgl=True, language="en", chromedriver="/usr/bin/chromedriver"):
    options = webdriver.ChromeOptions()
    flags = ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", f"--lang={language}", f"--window-size={width},{height}"]
    flags += ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"] if has_webgl else ["--disable-gpu", "--disable-3d-apis"]
    for flag in flags:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(service=Service(chromedriver), options=options)
    set_size(driver, width, height)
    set_dark(driver, is_dark)
    return driver


def set_size(driver, width, height, scale=1):
    """The size of the page itself, in its own pixels."""
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                           {"width": width, "height": height, "deviceScaleFactor": scale, "mobile": False})


def set_dark(driver, is_dark):
    value = "dark" if is_dark else "light"
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": value}]})


def wait_until(driver, what, condition, patience_s=PATIENCE_S):
    end = time.monotonic() + patience_s
    while time.monotonic() < end:
        try:
            result = condition()
        except (StaleElementReferenceException, JavascriptException):
            result = None
        if result:
            return result
        time.sleep(0.05)
    raise AssertionError(f"waited {patience_s} s for {what}; the page shows:\n{text_of_page(driver)}")


def text_of_page(driver):
    return driver.find_element(By.TAG_NAME, "body").text


def find(driver, selector):
    return driver.find_element(By.CSS_SELECTOR, selector)


def find_all(driver, selector):
    return driver.find_elements(By.CSS_SELECTOR, selector)


# ---- checks of any page

def check_no_sideways_scrolling(driver):
    wide, window = driver.execute_script("return [document.documentElement.scrollWidth, window.innerWidth]")
    assert wide <= window, f"the page is {wide} px wide in a window of {window} px"


def browser_log(driver):
    return [f"{entry['level']}: {entry['message']}" for entry in driver.get_log("browser")]


def check_browser_log_is_empty(driver, but_for=()):
    entries = [entry for entry in browser_log(driver) if not any(words in entry for words in but_for)]
    assert not entries, "the browser's log says:\n" + "\n".join(entries)


def axe_findings(driver):
    """What axe-core finds, all impacts: [(impact, rule, elements)]."""
    # The page's policy forbids inline scripts; a driver's script is not one.
    driver.execute_script(Path(AXE).read_text())
    result = driver.execute_async_script("""
        const done = arguments[arguments.length - 1];
        axe.run().then((found) => done(found.violations), (error) => done([{impact: "critical", id: String(error), nodes: []}]));
    """)
    return [(found["impact"], found["id"], [node["html"] + " | " + str(node.get("failureSummary")) for node in found["nodes"]]) for found in result]


def check_axe(driver, impacts=("minor", "moderate", "serious", "critical")):
    if AXE is None:
        return  # not installed here; the project's own checks install it
    found = [finding for finding in axe_findings(driver) if finding[0] in impacts]
    assert not found, f"axe-core finds: {found}"


def check_targets(driver, least_px=44):
    """Everything that can be touched is large enough."""
    small = driver.execute_script("""
        return [...document.querySelectorAll("button, .option, select, input:not([type=radio]), textarea")]
          .filter((one) => one.getClientRects().length)
          .map((one) => [one.textContent || one.id, one.getBoundingClientRect()])
          .filter(([, box]) => box.width < arguments[0] - 0.5 || box.height < arguments[0] - 0.5)
          .map(([name, box]) => `${name}: ${box.width} x ${box.height}`)""", least_px)
    assert not small, f"too small to touch: {small}"


def screenshot(driver, path):
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    driver.save_screenshot(str(path))


# ---- the participant's page

def open_participant(driver, url, is_plan=False):
    driver.get(url + ("?view=plan" if is_plan else ""))


def current_screen(driver):
    """{kind, number, title, text, status, options, progress} of the screen on show; None before the first."""
    return driver.execute_script("""
        const body = document.body;
        if (!body.dataset.kind || !document.querySelector("#screen > *")) return null;
        const words = (selector) => document.querySelector(selector)?.innerText.trim() ?? "";
        return {
          kind: body.dataset.kind, number: Number(body.dataset.screen), isSettled: body.dataset.settled === "true",
          title: words("#screen h1"), text: words("#screen"), status: words("#status"),
          progress: document.getElementById("progress").hidden ? "" : words("#progress-text"),
          options: [...document.querySelectorAll("#screen .option .face > span")].map((one) => one.innerText),
          alternatives: [...document.querySelectorAll("#screen .feel span")].map((one) => one.innerText),
          felt: [...document.querySelectorAll("#screen .feel")].findIndex((one) => one.ariaPressed === "true"),
          picked: [...document.querySelectorAll("#screen input[type=radio]")].findIndex((one) => one.checked),
          connection: body.dataset.connection ?? "", banner: words("#connection"),
          isBusy: document.getElementById("panel").ariaBusy === "true",
        }""")


def wait_for_screen(driver, *kinds, after=None, patience_s=PATIENCE_S):
    """The first settled screen of one of the kinds (any, if none is named), later than number `after`."""
    def there():
        screen = current_screen(driver)
        is_wanted = screen and screen["isSettled"] and (not kinds or screen["kind"] in kinds)
        return screen if is_wanted and (after is None or screen["number"] > after) else None
    return wait_until(driver, f"a screen {' or '.join(kinds)} after {after}", there, patience_s)


def wait_for_status(driver, words, patience_s=PATIENCE_S):
    wait_until(driver, f"the status “{words}”", lambda: words in find(driver, "#status").text, patience_s)


def record_go_signals(driver):
    """By the page itself: a look from outside now and then misses signals on a busy machine."""
    driver.execute_script("""
        const seen = window.goSignals = [];
        const look = () => {
          const go = document.querySelector(".go");
          const now = [go?.dataset.phase ?? "", go?.textContent ?? ""];
          if (JSON.stringify(now) !== JSON.stringify(seen.at(-1))) seen.push(now);
        };
        new MutationObserver(look).observe(
            document.body, {subtree: true, childList: true, attributes: true, characterData: true});
        look();""")
    return lambda: driver.execute_script("return window.goSignals")


def wait_for_view(driver, patience_s=PATIENCE_S):
    """What the plate is drawn with: "canvas" or "svg"."""
    return wait_until(driver, "the view", lambda: driver.execute_script(
        "return document.querySelector('#view:not([hidden]) > *')?.tagName.toLowerCase()"), patience_s)


def press(driver, *keys):
    """Presses keys as a person does who never touched the mouse."""
    ActionChains(driver).send_keys(*keys).perform()


def go_on_by_mouse(driver, patience_s=60):
    """Presses Go on once it can be pressed."""
    def enabled():
        button = find(driver, "#go-on")
        return button if button.is_enabled() else None
    wait_until(driver, "the Go-on button", enabled, patience_s).click()


def go_on_by_keyboard(driver, patience_s=60):
    wait_until(driver, "the Go-on button", lambda: find(driver, "#go-on").is_enabled(), patience_s)
    press(driver, Keys.ENTER)


def feel_by_mouse(driver, index):
    find_all(driver, "#screen .feel")[index].click()
    wait_until(driver, f"alternative {index} to be felt", lambda: current_screen(driver)["felt"] == index)


def feel_by_keyboard(driver, index):
    label = re.search(r"\b[A-Z]\b", find_all(driver, "#screen .feel")[index].text).group()
    press(driver, label.lower())
    wait_until(driver, f"alternative {index} to be felt", lambda: current_screen(driver)["felt"] == index)


def pick_by_mouse(driver, index):
    find_all(driver, "#screen .option")[index].click()


def answer_by_mouse(driver, index):
    """Picks the option (from 0), of a trial or of a confidence scale, and confirms it."""
    pick_by_mouse(driver, index)
    find(driver, "#confirm").click()


def answer_by_keyboard(driver, index):
    press(driver, str(index + 1))
    wait_until(driver, f"option {index} to be picked", lambda: current_screen(driver)["picked"] == index)
    press(driver, Keys.ENTER)


def has_number_field(driver):
    return bool(find_all(driver, "#number-answer"))


def move_by_mouse(driver, way):
    """One setting up or down."""
    find_all(driver, "#screen .move")[2 if way > 0 else 1].click()


def turn_wheel(driver, selector, notches):
    """Of a mouse, away from the hand where positive."""
    origin = ScrollOrigin.from_element(find(driver, selector))
    ActionChains(driver).scroll_from_origin(origin, 0, -100 * notches).perform()


def press_volume_up(driver):
    """WebDriver has no name for that key."""
    driver.execute_script("document.activeElement.dispatchEvent("
                          "new KeyboardEvent('keydown', {key: 'AudioVolumeUp', bubbles: true, cancelable: true}))")


def click_at(driver, element, share):
    """Where an element is so far from its left end."""
    ActionChains(driver).move_to_element_with_offset(element, round((share - 0.5) * element.size["width"]), 0).click().perform()


def answer_number_by_mouse(driver, number):
    """Enters the number of a trial's answer and confirms it."""
    field = find(driver, "#number-answer")
    field.clear()
    field.send_keys(number)
    find(driver, "#confirm").click()


def answer_number_by_keyboard(driver, number):
    driver.execute_script("document.querySelector('#number-answer').value = ''")
    press(driver, *number)
    wait_until(driver, f"{number} in the field",
               lambda: find(driver, "#number-answer").get_property("value") == number)
    press(driver, Keys.ENTER)


def focused(driver):
    return driver.switch_to.active_element


def tab_to(driver, selector, limit=80):
    """Moves the focus by the Tab key until it is on an element that matches."""
    for _ in range(limit):
        if driver.execute_script("return document.activeElement.matches(arguments[0])", selector):
            return
        press(driver, Keys.TAB)
    raise AssertionError(f"the Tab key never reaches {selector}")


def fill_in_by_mouse(driver, name, value):
    """Answers one item of a form: number from 1 (likert), label (single_choice), labels (multiple_choice), 0…1 (scale), text."""
    item = find(driver, f'.item[data-name="{name}"]')
    kind = item.get_attribute("class").split()[1]
    driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", item)
    if kind == "likert":
        item.find_elements(By.CSS_SELECTOR, ".option")[value - 1].click()
    elif kind == "single_choice":
        faces = item.find_elements(By.CSS_SELECTOR, ".option")
        next(face for face in faces if face.text.strip() == value).click()
    elif kind == "multiple_choice":
        for face in item.find_elements(By.CSS_SELECTOR, ".option"):
            if face.text.strip() in value:
                face.click()
    elif kind == "scale":
        slider = item.find_element(By.CSS_SELECTOR, "input")
        offset = round((value - 0.5) * (slider.size["width"] - 28))
        ActionChains(driver).move_to_element_with_offset(slider, offset, 0).click().perform()
    else:
        field = item.find_element(By.CSS_SELECTOR, "input, textarea")
        field.clear()
        field.send_keys(str(value))


def fill_in_by_keyboard(driver, name, value):
    """As by mouse; a scale is moved step by step from its middle."""
    kind = find(driver, f'.item[data-name="{name}"]').get_attribute("class").split()[1]
    tab_to(driver, f'.item[data-name="{name}"] :is(input, textarea)')
    if kind in ("likert", "single_choice"):
        labels = [face.text.strip() for face in find_all(driver, f'.item[data-name="{name}"] .option')]
        press(driver, Keys.SPACE)
        press(driver, *[Keys.ARROW_DOWN] * labels.index(str(value)))
    elif kind == "multiple_choice":
        for face in find_all(driver, f'.item[data-name="{name}"] .option'):
            if face.text.strip() in value:
                press(driver, Keys.SPACE)
            press(driver, Keys.TAB)
    elif kind == "scale":
        hundredths = round(100 * (value - 0.5))
        press(driver, Keys.SPACE, *[Keys.ARROW_RIGHT if hundredths > 0 else Keys.ARROW_LEFT] * abs(hundredths))
    else:
        press(driver, str(value))


def send_form_by_mouse(driver):
    button = find(driver, "#confirm")
    driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", button)
    button.click()


def send_form_by_keyboard(driver):
    tab_to(driver, "#confirm")
    press(driver, Keys.ENTER)


# ---- the operator's page

def open_operator(driver, url):
    driver.get(url)


def operator_state(driver):
    """{state, force, fault, warnings, possible, reply, log, trial, last, machine} as shown; None before the first."""
    return driver.execute_script("""
        if (!document.body.dataset.state) return null;
        const words = (id) => document.getElementById(id).innerText.trim();
        return {
          state: document.body.dataset.state, force: document.getElementById("force").dataset.force,
          force_text: words("force"), fault: words("fault"), warnings: words("warnings"), reply: words("reply"),
          trial: words("trial"), last: words("last"), machine: words("machine"),
          log: [...document.querySelectorAll("#log li:not(.muted)")].map((one) => one.innerText),
          possible: [...new Set([...document.querySelectorAll("button[data-action]:not(:disabled)")].map((one) => one.dataset.action))],
        }""")


def wait_for_state(driver, *states, patience_s=PATIENCE_S):
    def there():
        state = operator_state(driver)
        return state if state and state["state"] in states else None
    return wait_until(driver, f"the state {' or '.join(states)}", there, patience_s)


def command(driver, name):
    """Presses the button of an action that needs no words."""
    def enabled():
        button = find(driver, f'button[data-action="{name}"]')
        return button if button.is_enabled() else None
    wait_until(driver, f"the action {name}", enabled).click()


def command_by_keyboard(driver, name):
    wait_until(driver, f"the action {name}", lambda: find(driver, f'button[data-action="{name}"]').is_enabled())
    tab_to(driver, f'button[data-action="{name}"]')
    press(driver, Keys.ENTER)


def command_with_reason(driver, name, reason=""):
    """Presses the button of an action that asks for a reason, and gives it."""
    command(driver, name)
    field = wait_until(driver, "the dialog", lambda: find(driver, "dialog[open] #ask-reason"))
    field.send_keys(reason)
    find(driver, "dialog[open] button[type=submit]").click()


def is_dialog_open(driver):
    return bool(find_all(driver, "dialog[open]"))


def write_note(driver, text):
    find(driver, "#note-text").send_keys(text)
    command(driver, "note")


def write_note_by_keyboard(driver, text):
    tab_to(driver, "#note-text")
    press(driver, text)
    command_by_keyboard(driver, "note")


def switch_to(driver, index):
    """Renders another alternative (from 0)."""
    row = find_all(driver, "#trial li")[index]
    row.find_element(By.CSS_SELECTOR, "button").click()


def correct_to(driver, index):
    """Corrects the last answer to an option (from 0)."""
    Select(find(driver, "#correct-to")).select_by_index(1 + index)  # the first one is none
    command(driver, "correct")


def wait_for_reply(driver, patience_s=PATIENCE_S):
    return wait_until(driver, "a reply", lambda: find(driver, "#reply").text, patience_s)


def plot_in_words(driver, name):
    """The text alternative of a plot: "force" or "height"."""
    return find(driver, f"#plot-{name}").get_attribute("aria-label")
