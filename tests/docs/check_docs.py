#!/usr/bin/env python3
"""Checks the documentation: links of every Markdown file, and the commands that users are shown.

    tests/docs/check_docs.py                      # links only
    tests/docs/check_docs.py --program tapstudy   # also runs the commands with this program

Links: each relative link and image of each .md file of the checkout names a file that exists and
that Git does not ignore; an anchor names a heading, as GitHub spells it.

Commands: each line of a code block of README.md and docs/*.md that begins with `./run.sh` or
`tapstudy` (or `sqlite3 FILE "SQL"`, which Python runs) must end with the exit code 0. Each page gets
a copy of the checkout in a temporary folder, where its commands run in order; `--participants` and
`--simulations` are lowered to 2. Comments directly before a code block change that:

    <!-- commands: hardware -->     not run: the options are looked up in the command's --help
    <!-- commands: by hand -->      likewise, for what a person must answer or what takes minutes
    <!-- before: COMMAND -->        shell lines that run first and that the page does not show

A fenced block of python or r is run whole, in the same folder, and must end with the exit code 0.

Commands within a sentence (`tapstudy verify DIR`, `check --rig`), in all .md files but the
changelog, are looked up in --help.
Exit code: 0 if all is well, 1 with one line for each problem.
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SECONDS_A_COMMAND = 120
COMMAND = re.compile(r"(\./run\.sh|tapstudy|sqlite3)( |$)")
FENCE = re.compile(r"\s*(```|~~~)")
INTERPRETERS = {"python": ["/usr/bin/python3", "-c"], "r": ["/usr/bin/Rscript", "-e"]}
CODE_SPAN = re.compile(r"(`+)(.+?)\1")


def listed_files(root):
    """The files that Git tracks or would track, relative to root; in a checkout without Git all."""
    listing = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=root, capture_output=True, text=True)
    if listing.returncode == 0:
        names = [name for name in listing.stdout.split("\0") if name]
    else:
        names = [str(path.relative_to(root)) for path in root.rglob("*")
                 if path.is_file() and path.relative_to(root).parts[0] != "build"]
    return sorted(name for name in names if (root / name).is_file())


class Block:
    """A code block: its lines with their numbers, and the comments directly before it."""

    def __init__(self, comments, language=""):
        self.comments = comments
        self.language = language
        self.lines = []


def split(text):
    """Prose (number, line) and code blocks of a Markdown text."""
    prose, blocks, comments = [], [], []
    block, fence, previous_is_blank = None, None, True
    lines = iter(enumerate(text.split("\n"), 1))
    for number, line in lines:
        if fence:
            if line.strip().startswith(fence):
                block, fence = None, None
            else:
                block.lines.append((number, line))
            continue
        opening = FENCE.match(line)
        if opening:
            fence = opening.group(1)
            block = Block(comments, line.strip().removeprefix(fence))
            blocks.append(block)
            comments = []
        elif line.startswith("    ") and (block or previous_is_blank):
            if block is None:
                block = Block(comments)
                blocks.append(block)
                comments = []
            block.lines.append((number, line[4:]))
        elif line.lstrip().startswith("<!--"):
            comment = line
            while "-->" not in comment:
                comment += "\n" + next(lines, (0, "-->"))[1]
            comments.append(comment.split("<!--")[1].split("-->")[0].strip())
            block = None
        elif line.strip():
            prose.append((number, line))
            block, comments = None, []
        previous_is_blank = not line.strip() or line.lstrip().startswith("<!--")
    return prose, blocks


# --- links ---------------------------------------------------------------------------------------

def links(prose):
    for number, line in prose:
        line = re.sub(r"`[^`]*`", "`code`", line)
        for target in re.findall(r"\]\(<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\)", line):
            yield number, target
        for target in re.findall(r"(?:src|href)=\"([^\"]+)\"", line):
            yield number, target
        definition = re.match(r"\s*\[[^\]]+\]:\s+(\S+)", line)
        if definition:
            yield number, definition.group(1)


def anchors(text):
    """The anchors of a page's headings, as GitHub makes them."""
    found, seen = set(re.findall(r"(?:id|name)=\"([^\"]+)\"", text)), {}
    for _, line in split(text)[0]:
        heading = re.match(r"#{1,6}\s+(.*?)\s*#*$", line)
        if heading:
            title = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading.group(1))
            slug = re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
            found.add(slug if slug not in seen else f"{slug}-{seen[slug]}")
            seen[slug] = seen.get(slug, 0) + 1
    return found


def check_links(root, files):
    problems = []
    known = set(files) | {str(parent) for name in files for parent in pathlib.Path(name).parents}
    for page in (name for name in files if name.endswith(".md")):
        for number, target in links(split((root / page).read_text())[0]):
            if re.match(r"[a-z]+:", target):
                continue
            path, _, anchor = target.partition("#")
            name = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
            if name not in known:
                problems.append(f"{page}:{number}: {target}: there is no such file")
            elif anchor and name.endswith(".md") and anchor not in anchors(
                    (root / name).read_text()):
                problems.append(f"{page}:{number}: {target}: {name} has no such heading")
    return problems


# --- commands ------------------------------------------------------------------------------------

class Help:
    """Which options each command has, by its --help."""

    def __init__(self, program, environment):
        self.program, self.environment, self.texts = program, environment, {}

    def text(self, *command):
        if command not in self.texts:
            shown = subprocess.run([self.program, *command, "--help"], capture_output=True,
                                   text=True, env=self.environment, timeout=SECONDS_A_COMMAND)
            self.texts[command] = shown.stdout
        return self.texts[command]

    def has(self, command):
        return re.search(rf"^ +{command}\b", self.text(), re.MULTILINE) is not None

    def problem(self, command):
        """What is wrong with a command line; empty if command and options exist."""
        words = command.split()[1:]
        options = [re.match(r"--[\w-]+", word).group() for word in words
                   if re.match(r"--\w", word)]
        if not words or words[0].startswith("-"):
            known, name = self.text(), "tapstudy"
        elif self.has(words[0]):
            known, name = self.text(words[0]), words[0]
        else:
            return f"there is no command '{words[0]}'"
        for option in options:
            if not re.search(re.escape(option) + r"(?![\w-])", known) and option != "--help":
                return f"'{name}' has no option {option}"
        return ""


def commands(block):
    """(number, command) of a block, continuation lines joined, comments after ` #` kept."""
    lines = iter(block.lines)
    for number, line in lines:
        if not COMMAND.match(line):
            continue
        while line.endswith("\\") or line.count('"') % 2:
            joint = "" if line.endswith("\\") else "\n"
            _, following = next(lines, (0, '"'))
            line = line.removesuffix("\\") + joint + following
        yield number, line


def run_sql(command, folder):
    file, sql = re.match(r"sqlite3 (?:-\w+ )*(\S+) \"(.*)\"", command, re.DOTALL).groups()
    if not (folder / file).is_file():
        return f"there is no {file}"
    connection = sqlite3.connect(folder / file)
    try:
        connection.execute(sql).fetchall()
        return ""
    except sqlite3.Error as error:
        return str(error)
    finally:
        connection.close()


def run_shell(command, folder, environment):
    return run(["bash", "-euc", command], folder, environment)


def run(command, folder, environment):
    try:
        done = subprocess.run(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, timeout=SECONDS_A_COMMAND)
    except subprocess.TimeoutExpired:
        return f"takes longer than {SECONDS_A_COMMAND} s"
    if done.returncode == 0:
        return ""
    last = (done.stderr.strip() or done.stdout.strip()).splitlines()[-1:]
    return f"exit code {done.returncode}: {' '.join(last)}"


def smaller(command):
    return re.sub(r"(--(?:participants|simulations)) \d+", r"\1 2", command)


def check_page(page, folder, environment, help_):
    """The problems of one page, whose commands run in folder, a copy of the checkout."""
    problems = []
    for block in split((folder / page).read_text())[1]:
        ways = [comment.removeprefix("commands:").strip() for comment in block.comments
                if comment.startswith("commands:")]
        for comment in block.comments:
            if comment.startswith("before:"):
                wrong = run_shell(comment.removeprefix("before:"), folder, environment)
                if wrong:
                    problems.append(f"{page}:{block.lines[0][0]}: commands before it: {wrong}")
        for unknown in set(ways) - {"hardware", "by hand"}:
            problems.append(f"{page}:{block.lines[0][0]}: 'commands: {unknown}' means nothing")
        if block.language in INTERPRETERS:
            script = "\n".join(line for _, line in block.lines)
            wrong = run([*INTERPRETERS[block.language], script], folder, environment)
            if wrong:
                problems.append(f"{page}:{block.lines[0][0]}: this {block.language}: {wrong}")
        for number, command in commands(block):
            if re.fullmatch(r"\./run\.sh\s*(#.*)?", command):
                continue  # sets up and runs the demo: .ci/run does that
            if command.startswith("sqlite3"):
                wrong = run_sql(command, folder)
            else:
                wrong = help_.problem(command.split(" #")[0])
                if not wrong and not ways:
                    wrong = run_shell(smaller(command), folder, environment)
            if wrong:
                problems.append(f"{page}:{number}: {command.splitlines()[0]}: {wrong}")
    return problems


def check_mentions(page, text, help_):
    problems = []
    for number, line in split(text)[0]:
        for _, span in CODE_SPAN.findall(line):
            named = re.match(r"(\./run\.sh|tapstudy) ([a-z]+)\b", span)
            short = re.match(r"([a-z]+) .*--[a-z]", span)  # `check --rig`, if that is a command
            command = (span if named else
                       f"tapstudy {span}" if short and help_.has(short.group(1)) else None)
            wrong = help_.problem(command) if command else ""
            if wrong:
                problems.append(f"{page}:{number}: {span}: {wrong}")
    return problems


def copy_checkout(root, files, folder):
    for name in files:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(root / name, folder / name)
    (folder / "run.sh").write_text('#!/bin/sh\nexec tapstudy "$@"\n')
    (folder / "run.sh").chmod(0o755)


def check_commands(root, files, program):
    pages = [name for name in files if re.fullmatch(r"README\.md|docs/[^/]+\.md", name)]
    with tempfile.TemporaryDirectory(prefix="tapstudy_docs_") as name:
        temporary = pathlib.Path(name)
        (temporary / "bin").mkdir()
        (temporary / "bin/tapstudy").symlink_to(program)
        environment = dict(os.environ, HOME=name, TAPSTUDY_CACHE=str(temporary / "cache"),
                           PATH=f"{temporary / 'bin'}:{os.environ['PATH']}")
        help_ = Help(program, environment)
        problems = [problem for page in files if page.endswith(".md") and page != "CHANGELOG.md"
                    for problem in check_mentions(page, (root / page).read_text(), help_)]

        def check(page):
            folder = temporary / page.replace("/", "_")
            copy_checkout(root, files, folder)
            return check_page(page, folder, environment, help_)

        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            for found in pool.map(check, pages):
                problems += found
    return problems


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", type=pathlib.Path, help="tapstudy, to run the commands with")
    parser.add_argument("--root", type=pathlib.Path, default=ROOT, help="another checkout")
    arguments = parser.parse_args()
    root = arguments.root.resolve()
    files = listed_files(root)
    problems = check_links(root, files)
    if arguments.program:
        problems += check_commands(root, files, arguments.program.resolve(strict=True))
    print("\n".join(problems) or "documentation: all links and commands are good")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
