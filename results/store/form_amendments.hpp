#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "results/store/store.hpp"
// An answer to a questionnaire that the operator corrected. The answer as given stays where it is;
// the correction is an action of the operator beside it, with both, so that stores of every schema
// take it. All throw StoreError.
namespace tapstudy::results {
inline constexpr const char* form_amendment_action = "amend";

struct FormAmendment {
  std::int64_t session_id{};  // in which it was answered
  double t_s{};               // as in session_event
  std::string form;
  std::string asked;
  std::string item;
  std::optional<std::string> before;  // that held until then; unset: left out
  std::string after;
};

// The action that stores it.
OperatorActionRow action_of(Store& store, const FormAmendment& amendment);
// In the order in which they were made.
std::vector<FormAmendment> form_amendments(Store& store);

// What follows FROM where the answers to questionnaires that hold are read: form_answer, in which
// `answer` is the corrected one, with the columns amended and amended_from besides.
inline constexpr const char* current_form_answer =
    "(SELECT given_rowid AS rowid, session_id, t_s, form, asked, item, "
    "  amendment IS NOT NULL AS amended, "
    "  CASE WHEN amendment IS NOT NULL THEN answer END AS amended_from, "
    "  CASE WHEN amendment IS NULL THEN answer ELSE json_extract(amendment, '$.after') END "
    "    AS answer "
    "FROM (SELECT given.rowid AS given_rowid, given.*, "
    "  (SELECT detail FROM operator_action WHERE operator_action.session_id = given.session_id "
    // other actions have details that are no JSON, which CASE does not look into
    "    AND CASE WHEN action = 'amend' THEN json_extract(detail, '$.form') = given.form "
    "      AND json_extract(detail, '$.asked') = given.asked "
    "      AND json_extract(detail, '$.item') = given.item END "
    "    ORDER BY action_id DESC LIMIT 1) AS amendment "
    "  FROM form_answer AS given)) AS form_answer";
}  // namespace tapstudy::results
