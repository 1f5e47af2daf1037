#pragma once
#include <string>

#include "protocols/protocol.hpp"
#include "protocols/yaml/changed_texts.hpp"
#include "results/store/store.hpp"
namespace tapstudy::runner {
// What the text of a later protocol of a study says otherwise than the study's own. It may name the
// same surfaces only. Throws InvalidInput where it cannot be read.
protocols::ChangesOfFile changes_in(const protocols::Protocol& of_study,
                                    const std::string& later_text);

// "'Which?' is now 'Which one?'", for people.
std::string described(const protocols::ChangedText& text);

// The store of the study of this protocol, which is created where there is none. A protocol that
// differs from the study's in texts for people only is said to, and goes on. Throws InvalidInput
// with the keys where it differs in what may enter the data.
results::Store open_study(const std::string& directory, const protocols::Protocol& protocol,
                          const std::string& protocol_file);
}  // namespace tapstudy::runner
