#include <fmt/format.h>

#include "analysis/blocks/html_parts.hpp"
#include "analysis/choice/choice_words.hpp"
#include "core/print.hpp"
namespace tapstudy::analysis {
void ChoiceSummary::write_html(std::ostream& out) const {
  const double chance = 1.0 / static_cast<double>(alternatives.size());
  out << "<div class=scroll tabindex=0 role=group aria-label=Choices>"
         "<table class=accuracy><thead><tr><td></td><th>chosen</th><td></td><th>visits</th>"
         "<th>time tried</th></tr></thead>\n";
  for (const AlternativeResult& result : alternatives) {
    core::print(
        out, "<tr><th scope=row>{}</th><td>{}</td><td>{}</td><td>{}</td><td>{:.1f} s</td></tr>\n",
        escaped(result.item.label), chosen_words(result),
        result.interval
            ? dot_plot(result.chosen.value(), *result.interval, chance, chosen_words(result))
            : "",
        result.visits, result.dwell_s);
  }
  core::print(
      out,
      "</table></div>\n<p class=note>Intervals: 95 %, of all alternatives at once "
      "(Goodman 1965); in the tables also others (Sison & Glaz 1995).</p>\n<p>All alternatives "
      "equally likely: {}.{}</p>\n",
      escaped(multinomial_words(*this)),
      has_repeated_choices ? fmt::format(" Of {} choices each participant has one vote: {}.",
                                         choices.size(), words_of(vote))
                           : "");
  write_hypotheses_html(out, hypotheses);
  write_sections_html(out, sections, block);
}
}  // namespace tapstudy::analysis
