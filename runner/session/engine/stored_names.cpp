#include "runner/session/engine/stored_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/text/plain_text.hpp"
#include "protocols/axes/axis.hpp"
#include "protocols/schedule/schedule.hpp"
#include "results/store_error.hpp"
#include "runner/session/engine/between_trials.hpp"
namespace tapstudy::runner {
namespace {
using core::quoted_name;
using protocols::Block;
using protocols::Protocol;
using results::Statement;
using results::Store;

void add_unknown_blocks(Store& store, const Protocol& protocol, std::vector<std::string>& found) {
  store.each_row(
      "SELECT block, task, min(trial_id) FROM trial GROUP BY block, task ORDER BY 3",
      [&](Statement& row) {
        const std::string name = row.text(0);
        const Block* const block = protocol.find_block(name);
        if (block == nullptr) {
          found.push_back(fmt::format("trial {} is of block {}, which the protocol lacks",
                                      row.integer(2), quoted_name(name)));
        } else if (row.text(1) != block->task->name()) {
          found.push_back(fmt::format("trial {} has the task {}, its block '{}' has '{}'",
                                      row.integer(2), quoted_name(row.text(1)), name,
                                      block->task->name()));
        }
      });
}

// A participant's sessions share one order, and so do the trials of all of them.
void add_unplanned_blocks(Store& store, std::vector<std::string>& found) {
  std::map<std::string, std::set<std::string>> blocks_of;
  store.each_row("SELECT DISTINCT participant_id, block FROM trial JOIN session USING (session_id)",
                 [&](Statement& row) { blocks_of[row.text(0)].insert(row.text(1)); });
  for (const results::SessionRow& session : store.sessions()) {
    const auto planned = protocols::first_trials(session.planned_order);
    for (const std::string& block : blocks_of[session.participant_id]) {
      if (!planned.contains(block)) {
        found.push_back(
            fmt::format("session {} (participant {}): its order lacks block {}, of "
                        "which there are trials",
                        session.id, quoted_name(session.participant_id), quoted_name(block)));
      }
    }
  }
}

void add_unknown_groups(Store& store, const Protocol& protocol, std::vector<std::string>& found) {
  std::set<std::string> seen;
  for (const results::SessionRow& session : store.sessions()) {
    if (session.group && seen.insert(session.group->name).second &&
        std::ranges::find(protocol.groups, session.group->name, &protocols::Group::name) ==
            protocol.groups.end()) {
      found.push_back(fmt::format("participant {} is in group {}, which the protocol lacks",
                                  quoted_name(session.participant_id),
                                  quoted_name(session.group->name)));
    }
  }
}

void add_unknown_stimuli(Store& store, const Protocol& protocol, std::vector<std::string>& found) {
  store.each_row(
      "SELECT stimulus, min(trial_id) FROM alternative GROUP BY stimulus ORDER BY 2",
      [&](Statement& row) {
        const std::string name = row.text(0);
        if (std::ranges::find(protocol.stimuli, name, &protocols::Stimulus::name) ==
            protocol.stimuli.end()) {
          found.push_back(fmt::format("trial {} presents {}, a stimulus that the protocol lacks",
                                      row.integer(1), quoted_name(name)));
        }
      });
  store.each_row("SELECT axis, min(trial_id) FROM axis_value GROUP BY axis ORDER BY 2",
                 [&](Statement& row) {
                   if (protocols::find_axis(row.text(0)) == nullptr) {
                     found.push_back(fmt::format("trial {} has a value of {}, which is no axis",
                                                 row.integer(1), quoted_name(row.text(0))));
                   }
                 });
}

bool has_item(const Protocol& protocol, const std::string& form, const std::string& item) {
  const auto found = protocol.forms.find(form);
  return found != protocol.forms.end() &&
         std::ranges::find(found->second.items, item, &protocols::FormItem::name) !=
             found->second.items.end();
}

void add_unknown_items(Store& store, const Protocol& protocol, std::vector<std::string>& found) {
  store.each_row(
      "SELECT form, item, asked, min(session_id) FROM form_answer GROUP BY form, item, asked "
      "ORDER BY 4",
      [&](Statement& row) {
        const std::string asked = row.text(2);
        if (!has_item(protocol, row.text(0), row.text(1))) {
          found.push_back(
              fmt::format("session {} has an answer to {} of questionnaire {}, which the protocol "
                          "lacks",
                          row.integer(3), quoted_name(row.text(1)), quoted_name(row.text(0))));
        }
        if (asked != asked_at_begin && asked != asked_at_end &&
            protocol.find_block(asked) == nullptr) {
          found.push_back(
              fmt::format("session {} has an answer that was asked at {}, which is '{}', '{}' or a "
                          "block of the protocol",
                          row.integer(3), quoted_name(asked), asked_at_begin, asked_at_end));
        }
      });
}
}  // namespace

std::vector<std::string> unknown_names(Store& store, const Protocol& protocol) {
  std::vector<std::string> found;
  add_unknown_blocks(store, protocol, found);
  add_unplanned_blocks(store, found);
  add_unknown_groups(store, protocol, found);
  add_unknown_stimuli(store, protocol, found);
  add_unknown_items(store, protocol, found);
  return found;
}

void check_names(Store& store, const Protocol& protocol) {
  const std::vector<std::string> found = unknown_names(store, protocol);
  if (!found.empty()) {
    throw results::StoreError{
        fmt::format("{}: {} (tapstudy verify says more)", store.directory(), found.front())};
  }
}
}  // namespace tapstudy::runner
