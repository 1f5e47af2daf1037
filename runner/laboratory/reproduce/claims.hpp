#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/report/document/chart.hpp"
#include "core/model/progress.hpp"
#include "runner/laboratory/reproduce/paper_protocols.hpp"
#include "runner/laboratory/trade/trade.hpp"
#include "runner/session/stimuli/model_library.hpp"
namespace tapstudy::runner {
// A claim of the paper beside what tapstudy gets. The judgement is computed from the numbers:
//   a measure holds if its value lies within its limits; one without is only shown, and holds
//   a method judges the claim if one of its measures has a limit, and confirms it if all hold: what
//   repeats the paper's own numbers, or tells of this machine, has none
//   a claim is true if every method that judges confirms it, false if none does; else it depends on
//   the method; where the paper leaves out an input of it, it depends on that; where no method
//   judges, it is shown

struct Measure {
  std::string name;
  double value{};  // NaN lies within no limit
  std::string unit;
  std::optional<double> at_least{};  // in the same unit
  std::optional<double> at_most{};
  bool is_judged() const { return at_least || at_most; }
  bool holds() const;
};
Measure at_least(double limit, const std::string& name, double value, const std::string& unit = {});
Measure at_most(double limit, const std::string& name, double value, const std::string& unit = {});
Measure within(double low, double high, const std::string& name, double value,
               const std::string& unit = {});
Measure shown(const std::string& name, double value, const std::string& unit = {});
double difference_percent(double value, double printed);
// "1.25 mm"; and of a measure that is judged "at least 1.5 mm", "between 1 and 2 mm".
std::string describe_value(const Measure& measure);
std::string describe_limits(const Measure& measure);

// One way to compute what the claim is about.
struct Method {
  std::string name;
  std::string command;  // of tapstudy, that shows the numbers
  std::vector<Measure> measures;
  bool judges() const;
  bool confirms() const;  // false if it does not judge
};

enum class ClaimVerdict { confirmed, refuted, depends, shown };
// "true", "false", "depends", "shown"
std::string_view name(ClaimVerdict verdict);

// Drawn on the page below a heading of its own; `svg` is complete, with its caption.
struct Drawing {
  std::string title;
  std::vector<std::string> svg;
  bool is_open{true};  // else the reader unfolds it
};

// Shown on the page, and a file of its own beside it.
struct Animation {
  std::string title;
  std::string file;
  std::string png;
};

struct Claim {
  std::string name;       // of its place on the page and in JSON
  std::string section;    // of the paper
  std::string statement;  // in our words
  std::string rule;       // when a measure holds, and why that limit
  // What the result rests on, was chosen here and is not in the paper; empty: nothing.
  std::string unknown_input{};
  std::vector<Method> methods{};
  std::vector<Measure> findings{};  // beside the judgement: what would give it, and the like
  std::vector<std::string> remarks{};
  std::vector<Drawing> drawings{};
  std::vector<Animation> animations{};
  ClaimVerdict verdict() const;
  // The unknown input; the methods that confirm the claim, and the failing measures of each of the
  // others; those that judge nothing.
  std::vector<std::string> reasons() const;
};

// A statement of the paper that no computation can test.
struct NotReproducible {
  std::string section;
  std::string statement;
  std::string why;
};

namespace method {
inline constexpr std::string_view printed = "as printed";
inline constexpr std::string_view recommended = "as recommended";
}  // namespace method

// The settings and models shared by all measurements.
struct Bench {
  Effort effort{Effort::full};  // quick: fewer simulated participants, fewer thicknesses
  std::uint64_t seed{1};
  core::ProgressHook progress{};
  ModelLibrary models{};
  std::vector<Route> plates{routes()};  // of Figures 4 and 5
  bool is_quick() const { return effort == Effort::quick; }
};

// The animation of Figure 3, a file beside the page.
inline constexpr std::string_view strike_animation_file = "figure_3.png";

// Claims that are measured together. To add some: a file with a function, declared here, and a row
// in claims.cpp.
struct ClaimGroup {
  std::string_view name;  // by which `reproduce --only` chooses it
  std::string_view title;
  std::vector<Claim> (*measure)(Bench& bench);
};
const std::vector<ClaimGroup>& claim_groups();
std::vector<std::string> claim_group_names();
// All without names. Throws InvalidInput for a name that is of no group.
std::vector<ClaimGroup> claim_groups_named(const std::vector<std::string>& names);

std::vector<Claim> plate_model(Bench& bench);       // Table 1
std::vector<Claim> mode_count(Bench& bench);        // section 5.1
std::vector<Claim> mode_shapes(Bench& bench);       // Figure 3
std::vector<Claim> feedback_forces(Bench& bench);   // Figures 4 and 5
std::vector<Claim> step_time(Bench& bench);         // section 5.1
std::vector<Claim> finger_mass(Bench& bench);       // sections 5 and 7
std::vector<Claim> finger_vibration(Bench& bench);  // section 5.2.3
std::vector<Claim> discrimination(Bench& bench);    // Table 2
std::vector<Claim> reality(Bench& bench);           // sections 5.2.2 and 5.2.3

// The statements that no computation can test, and why.
const std::vector<NotReproducible>& not_reproducible();

struct MeasuredGroup {
  std::string title;
  std::vector<Claim> claims;
};

struct Reproduction {
  std::uint64_t seed{};
  Effort effort{};
  std::vector<std::string> only;  // groups by name; empty: all
  std::string program;            // its version and commit
  std::string machine;            // processor and system, on which times were measured
  std::vector<MeasuredGroup> groups;
  std::vector<NotReproducible> not_reproducible;
};

// Measures the claims of these groups, or of all. Progress is told in words. Throws InvalidInput
// for a name that is of no group, and Stopped if a stop was requested.
Reproduction reproduce(Bench& bench, const std::vector<std::string>& only = {});
}  // namespace tapstudy::runner
