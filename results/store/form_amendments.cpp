#include "results/store/form_amendments.hpp"
namespace tapstudy::results {
OperatorActionRow action_of(Store& store, const FormAmendment& amendment) {
  Statement row =
      store.query("SELECT json_object('form', ?, 'asked', ?, 'item', ?, 'before', ?, 'after', ?)");
  row.bind(amendment.form)
      .bind(amendment.asked)
      .bind(amendment.item)
      .bind(amendment.before)
      .bind(amendment.after)
      .step();
  return {amendment.session_id, amendment.t_s, form_amendment_action, std::nullopt, row.text(0)};
}

std::vector<FormAmendment> form_amendments(Store& store) {
  Statement row = store.query(
      "SELECT session_id, t_s, coalesce(detail ->> '$.form', ''), "
      "  coalesce(detail ->> '$.asked', ''), coalesce(detail ->> '$.item', ''), "
      "  detail ->> '$.before', coalesce(detail ->> '$.after', '') "
      "FROM operator_action WHERE action = 'amend' ORDER BY action_id");
  std::vector<FormAmendment> amendments;
  while (row.step()) {
    amendments.push_back({row.integer(0), row.real(1), row.text(2), row.text(3), row.text(4),
                          row.optional_text(5), row.text(6)});
  }
  return amendments;
}
}  // namespace tapstudy::results
