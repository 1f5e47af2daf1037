#include "runner/experiments/places_in_blocks.hpp"

#include <map>
#include <unordered_map>

#include "protocols/block_order.hpp"
namespace tapstudy::runner {
void set_places(const protocols::Protocol& protocol,
                const std::vector<results::SessionRow>& sessions,
                std::vector<results::AnswerRow>& answers) {
  // all sessions of a participant have one order
  std::unordered_map<std::string, std::map<std::string, int>> first_trials_of;
  for (const results::SessionRow& session : sessions) {
    first_trials_of.try_emplace(
        session.participant_id,
        protocols::first_trials(protocol, session.seed, session.order_index));
  }
  for (results::AnswerRow& answer : answers) {
    answer.place_in_block =
        answer.number - first_trials_of.at(answer.participant_id).at(answer.block);
  }
}
}  // namespace tapstudy::runner
