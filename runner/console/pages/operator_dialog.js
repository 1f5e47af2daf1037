// Asks once more before an action that needs words, and for its reason.

import { byId, el } from "./dom.js";
import { word, wordOr } from "./words.js";

// send(reason) resolves to whether it was taken; only then the dialog closes.
export function askReason({ name, title, isRequired, send }) {
  const dialog = byId("ask");
  const input = el("input", {
    type: "text", id: "ask-reason", autocomplete: "off", required: isRequired, "aria-describedby": "ask-error",
  });
  const error = el("p", { className: "error", id: "ask-error", role: "status" });
  const consequence = wordOr(`ask_${name}`, null);
  const isDangerous = name === "end" || name === "exclude";
  const form = el("form", { noValidate: true },
    el("h2", { id: "ask-title" }, title),
    consequence ? el("p", {}, consequence) : null,
    el("label", { htmlFor: "ask-reason" }, word(isRequired ? "ask_reason" : "ask_reason_optional")),
    input, error,
    el("div", { className: "row end" },
      el("button", { type: "button", onclick: () => dialog.close() }, word("ask_cancel")),
      el("button", { type: "submit", className: isDangerous ? "danger main" : "main" }, wordOr(`ask_do_${name}`, title))));

  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    const reason = input.value.trim();
    if (isRequired && !reason) {
      error.textContent = word("reason_needed");
      input.setAttribute("aria-invalid", "true");
      input.focus();
    } else if (await send(reason)) {
      dialog.close();
    } else {
      error.textContent = byId("reply").textContent;
    }
  });
  dialog.replaceChildren(form);
  dialog.showModal();
  input.focus();
}
