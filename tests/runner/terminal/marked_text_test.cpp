#include "runner/terminal/marked_text.hpp"

#include "support/catch.hpp"
using tapstudy::runner::marked_text;

TEST_CASE("A heading and bold words are shown at a terminal without their marks",
          "[runner][terminal]") {
  const std::string text =
      "# Welcome\nTap **once**, then **answer**.\n- a # b\n- 2 ** 3\n# Begin\n";
  CHECK(marked_text(text, false) == "Welcome\nTap once, then answer.\n- a # b\n- 2 ** 3\nBegin\n");
  CHECK(marked_text("# Welcome\nTap **once**.", true) ==
        "\033[1mWelcome\033[0m\nTap \033[1monce\033[0m.");
}
