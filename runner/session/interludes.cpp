#include "runner/session/interludes.hpp"
namespace tapstudy::runner {
void Interludes::before(const protocols::PlannedTrial& trial) {
  const protocols::Block& block = protocol_.block(trial.block);
  if (!has_begun_) {
    has_begun_ = true;
    read(protocol_.instructions, "study");
  }
  if (block_ != trial.block) {
    block_ = trial.block;
    since_rest_ = 0;
    read(block.instructions, block.name);
  }
  if (block.breaks && since_rest_ == block.breaks->every_trials) {
    since_rest_ = 0;
    states_.enter(SessionState::resting);
    participant_.rest(block.breaks->min_seconds);
  }
  ++since_rest_;
}

void Interludes::read(const std::string& text, const std::string& whose) {
  if (!text.empty()) {
    states_.enter(SessionState::instructions, {}, whose);
    participant_.read(text);
  }
}
}  // namespace tapstudy::runner
