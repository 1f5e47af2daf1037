#pragma once
#include <array>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/report/document/cells.hpp"
#include "analysis/report/document/chart.hpp"
namespace tapstudy::analysis {
// A part of a long report: tables, figures and sentences under one heading.
struct ReportSection {
  std::string title;
  std::vector<ReportTable> tables{};  // those without rows are left out for people
  std::vector<Chart> charts{};
  std::vector<CitingText> remarks{};    // how it was computed, and what could not be
  std::vector<Chart> folded_charts{};   // shown on demand
  bool is_detail{};                     // for the page and files; not printed beside results
  std::string name{};                   // by which it is asked for, where it is of a whole study
  std::vector<std::string> findings{};  // results in words, for the head of the page
  std::vector<std::string> terminal_lines{};  // results in words; in text only
};

// The sections of a whole study.
namespace study_sections {
inline constexpr std::string_view contrasts = "contrasts";
inline constexpr std::string_view groups = "groups";
inline constexpr std::string_view retest = "retest";
inline constexpr std::string_view mixed_models = "mixed_models";
inline constexpr std::string_view sessions = "sessions";
inline constexpr std::string_view confidence = "confidence";
inline constexpr std::string_view procedures = "procedures";
inline constexpr std::string_view questionnaires = "questionnaires";
inline constexpr std::string_view rendered = "rendered";
inline constexpr std::array all{contrasts,  groups,     retest,         mixed_models, sessions,
                                confidence, procedures, questionnaires, rendered};
}  // namespace study_sections

// The same without its title.
void write_contents_text(std::ostream& out, const ReportSection& section,
                         std::size_t most_lines = all_lines);
void write_contents_html(std::ostream& out, const ReportSection& section);
// Titles, tables and remarks; figures are left out.
void write_sections_text(std::ostream& out, std::span<const ReportSection> sections,
                         std::size_t most_lines = all_lines);
// Each under its heading; browsers open what is linked to. `anchor`: of the block, unlike that of
// others.
void write_sections_html(std::ostream& out, std::span<const ReportSection> sections,
                         const std::string& anchor, bool are_folded);
// Links to them, one after another.
std::string section_links(std::span<const ReportSection> sections, const std::string& anchor);
// Every table under its name, and "remarks".
void add_sections(nlohmann::ordered_json& json, const std::vector<ReportSection>& sections);
// Those that are written as files of their own, TABLE.csv.
std::vector<const ReportTable*> csv_tables(const std::vector<ReportSection>& sections);
// Every table that people see of a section in this format: those with a row and a column for them.
std::vector<const ReportTable*> tables_shown(const ReportSection& section, bool ShownIn::*format);
// Adds the publications that the page cites in the section.
void add_sources(std::set<core::Source>& sources, const ReportSection& section);
}  // namespace tapstudy::analysis
