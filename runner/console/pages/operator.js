// The operator's page: the state of the session, the operator's actions, and the live plots.

import { listen } from "./connection.js";
import { byId, el, onThemeChange, setText, showIfChanged } from "./dom.js";
import { Actions } from "./operator_actions.js";
import { showLastAnswer, showLog, showMachine, showTrial } from "./operator_parts.js";
import { LivePlots } from "./operator_plots.js";
import { loadWords, SessionTime, word, wordOr } from "./words.js";

let state = null;
let actions = null;
let plots = null;
const time = new SessionTime(() => showSession(state));

const isOver = ({ state: name }) => ["ended", "stopped"].includes(name);

function showSession(next) {
  const { study, participant, mode, is_blind: isBlind } = next;
  setText(byId("study"), study);
  document.title = `${study} – ${word("operator")}`;
  const parts = [word("session_line", { participant, mode: wordOr(`mode_${mode}`, mode) })];
  if (isBlind) parts.push(word("blind"));
  time.note(next.progress, isOver(next));
  if (time.progress) parts.push(word("done", time.progress), time.text());
  setText(byId("session"), parts.join(" · "));
}

function forceOf({ force_is_off: isOff }) {
  if (isOff === true) return "off";
  return isOff === false ? "on" : "unknown";
}

function showForce(force) {
  setText(byId("force"), word(`force_${force}`));
  byId("force").dataset.force = force;
}

function showBadges(next) {
  const isPauseDue = next.is_paused && next.state !== "paused" && !isOver(next);
  const state = wordOr(`state_${next.state}`, next.state);
  setText(byId("state"), isPauseDue ? `${state} · ${word("pause_due")}` : state);
  byId("state").dataset.state = next.state;
  showForce(forceOf(next));
  setText(byId("fault"), next.state === "faulted" ? word("fault_text") : "");
}

function showWarnings({ warnings, waits_for: task }) {
  const texts = (warnings ?? []).map((text) => word("warning", { text }));
  if (task) texts.push(word("waits_for", { text: task, action: word("action_resume") }));
  showIfChanged(byId("warnings"), texts, () => texts.map((text) => el("p", {}, text)));
}

function showTitles() {
  for (const name of ["trial", "actions", "plots", "last", "machine", "log"]) {
    setText(byId(`${name}-title`), word(name === "last" ? "last_answer" : name));
  }
}

function showState(next) {
  state = next;
  document.body.dataset.state = next.state;
  showTitles();
  showSession(next);
  showBadges(next);
  showWarnings(next);
  showTrial(next, actions);
  showLastAnswer(next, actions);
  showMachine(next);
  showLog(next.log ?? []);
  actions.show(isOver(next) ? { ...next, actions: [] } : next);
  plots.showWords();
}

async function start() {
  await loadWords();
  actions = new Actions();
  plots = new LivePlots(byId("plots"));
  onThemeChange(() => plots.draw());
  const handlers = { state: showState, live: (samples) => plots.add(samples) };
  listen(handlers, () => state !== null && isOver(state), () => showForce("unknown"));
}

start();
