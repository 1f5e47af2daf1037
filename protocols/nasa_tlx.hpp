#pragma once
#include <string>
#include <vector>

#include "protocols/form.hpp"
namespace tapstudy::protocols {
// The task load index of NASA, six scales without weights ("raw TLX"; Hart and Staveland 1988, Hart
// 2006). The English wording is that of the agency's own form, a work of the United States
// government. The others translate it; they are not validated versions.
Form nasa_tlx(const std::string& language);  // English if it has no other wording
const std::vector<std::string>& nasa_tlx_languages();
// Whether the form asks these six scales and nothing else, in whatever words: its score is then the
// mean of the six.
bool is_raw_tlx(const Form& form);
}  // namespace tapstudy::protocols
