// The operator's actions: one button each, sent in the words used at the terminal.

import { post } from "./connection.js";
import { byId, el, setText, showIfChanged } from "./dom.js";
import { askReason } from "./operator_dialog.js";
import { word, wordOr } from "./words.js";

const elsewhere = new Set(["note", "switch", "correct"]);
const dangerous = new Set(["end", "exclude"]);
// Stopping the hand must not wait for words.
const immediate = new Set(["pause", "resume"]);
// The trial that was shown when the button was pressed, not one that has begun since.
const ofTrial = new Set(["repeat", "skip"]);

export class Actions {
  #possible = new Map();
  #isSending = false;
  #trial;

  isPossible(name) {
    return (!this.#isSending || immediate.has(name)) && this.#possible.get(name) === true;
  }

  show({ actions, trial }) {
    this.#trial = trial?.number;
    this.#possible = new Map((actions ?? []).map(({ name, is_possible: is }) => [name, is]));
    const listed = (actions ?? []).filter(({ name }) => !elsewhere.has(name));
    showIfChanged(byId("actions").querySelector("div"), listed, () => listed.map((action) => this.#button(action)));
    showIfChanged(byId("note"), this.#possible.has("note"), (has) => (has ? this.#noteFields() : []));
    this.#enable();
  }

  // Whether the command was taken.
  async send(command, what) {
    if (immediate.has(command)) return this.#tell(await this.#replyTo(command, what));
    if (this.#isSending) return false;
    this.#isSending = true;
    this.#enable();
    const reply = await this.#replyTo(command, what);
    this.#isSending = false;
    this.#enable();
    return this.#tell(reply);
  }

  #tell(reply) {
    setText(byId("reply"), reply.text);
    byId("reply").classList.toggle("error", !reply.isAccepted);
    return reply.isAccepted;
  }

  async #replyTo(command, what) {
    try {
      const { accepted, why } = await post({ command });
      const text = accepted ? word("accepted", { what }) : word("not_accepted", { why: why ?? "" });
      return { isAccepted: accepted, text };
    } catch {
      return { isAccepted: false, text: word("not_sent") };
    }
  }

  // A button with data-action can be pressed where that action is possible.
  #enable() {
    for (const button of document.querySelectorAll("button[data-action]")) {
      this.enable(button);
    }
  }

  enable(button) {
    button.disabled = !this.isPossible(button.dataset.action) || button.dataset.isDone === "true";
  }

  #button({ name, takes_text: takesText, needs_text: needsText }) {
    const label = wordOr(`action_${name}`, name);
    const button = el("button", { type: "button", className: dangerous.has(name) ? "danger" : "" }, label);
    button.dataset.action = name;
    button.addEventListener("click", () => this.#press(name, label, takesText, needsText));
    return button;
  }

  async #press(name, label, takesText, isRequired) {
    const what = label.replace(/\s*…$/, "");
    if (!takesText || immediate.has(name)) {
      await this.send(name, what);
      return;
    }
    const words = ofTrial.has(name) && this.#trial !== undefined ? `${name} @${this.#trial}` : name;
    askReason({ name, title: what, isRequired, send: (reason) => this.send(`${words} ${reason}`.trim(), what) });
  }

  #noteFields() {
    const input = el("input", { type: "text", id: "note-text", autocomplete: "off" });
    const button = el("button", { type: "submit" }, word("note_add"));
    button.dataset.action = "note";
    byId("note").onsubmit = async (event) => {
      event.preventDefault();
      const text = input.value.trim();
      if (!text) {
        setText(byId("reply"), word("note_empty"));
        input.focus();
      } else if (await this.send(`note ${text}`, word("action_note"))) {
        // What was typed meanwhile belongs to the next note.
        if (input.value.trim() === text) input.value = "";
      }
    };
    return [el("label", { htmlFor: "note-text" }, word("note_label")), el("div", { className: "row" }, input, button)];
  }
}
