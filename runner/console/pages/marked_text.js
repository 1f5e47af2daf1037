// Text of a study: paragraphs, "- " lists, "# " headings, **bold**. Everything else is plain.

import { el } from "./dom.js";

function inline(text) {
  return text
    .split(/\*\*(.+?)\*\*/)
    .map((part, index) => (index % 2 ? el("strong", {}, part) : part))
    .filter((part) => part !== "");
}

function withLineBreaks(lines) {
  return lines.flatMap((line, index) => (index ? [el("br"), ...inline(line)] : inline(line)));
}

function blocksOf(text) {
  const blocks = [];
  let open = null;
  for (const raw of text.split(/\r?\n/)) {
    const line = raw.trim();
    const kind = !line ? null : line.startsWith("# ") ? "heading" : line.startsWith("- ") ? "list" : "lines";
    const content = kind === "heading" || kind === "list" ? line.slice(2) : line;
    // An indented line after a list's entry continues that entry.
    if (kind === "lines" && open?.kind === "list" && /^\s/.test(raw)) {
      open.lines[open.lines.length - 1] += ` ${content}`;
    } else if (kind && kind !== "heading" && open?.kind === kind) {
      open.lines.push(content);
    } else {
      open = kind ? { kind, lines: [content] } : null;
      if (open) blocks.push(open);
    }
  }
  return blocks;
}

function elementOf({ kind, lines }) {
  if (kind === "heading") return el("h2", {}, ...inline(lines[0]));
  if (kind === "list") return el("ul", {}, ...lines.map((line) => el("li", {}, ...inline(line))));
  return el("p", {}, ...withLineBreaks(lines));
}

// {title, body}: the title is the text's first line if that is a heading.
export function markedText(text) {
  const blocks = blocksOf(text ?? "");
  const title = blocks[0]?.kind === "heading" ? blocks.shift().lines[0] : null;
  return { title, body: blocks.map(elementOf) };
}
