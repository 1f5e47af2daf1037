#pragma once
#include <map>
#include <string>
#include <vector>

#include "results/export/study_export.hpp"
#include "results/store.hpp"
namespace tapstudy::results {
// A questionnaire as a measurement tool of BIDS, asked at one place of the session.
struct Phenotype {
  std::string name;  // of its files, without ending: letters, digits and '_'
  // A row for each participant who did a trial, as BIDS asks, also where nothing was answered; a
  // column an item. Free text is left out.
  std::string table;
  std::string sidecar;  // JSON: the questions and what their answers mean
};
// Of each questionnaire and each place at which somebody was asked it. labels: of participants.
std::vector<Phenotype> phenotypes(Store& store, const std::vector<FormText>& forms,
                                  const std::map<std::string, std::string>& labels);
}  // namespace tapstudy::results
