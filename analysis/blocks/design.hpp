#pragma once
#include <string>
#include <vector>

#include "analysis/statistics/confusion_matrix.hpp"
namespace tapstudy::analysis {
// The part of a study's design that its report needs.
struct PlannedHypothesis {
  std::string name;
  std::string statement;
  std::string stimulus;  // expected choice; empty if the claim is not about one stimulus
};
struct BlockDesign {
  std::string name;
  std::string task;
  std::string question;
  std::string statistic;  // that summarises it: a row of report/statistic.cpp
  std::vector<Item> stimuli;
  std::vector<Item> responses;  // where they are not the stimuli
  std::vector<PlannedHypothesis> hypotheses;
};
struct StudyDesign {
  std::string title;
  std::string notes;
  std::vector<BlockDesign> blocks;  // practice left out
};
}  // namespace tapstudy::analysis
