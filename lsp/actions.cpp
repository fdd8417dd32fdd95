#include "lsp/actions.hpp"

#include <vector>

#include "support/names.hpp"

namespace hysteron::lsp {

std::optional<std::string> proposed_word(std::string_view written, std::string_view mend) {
  constexpr std::string_view question = "did you mean ";
  if (equal_ignoring_case(mend.substr(0, question.size()), question)) {
    const std::string_view word = mend.substr(question.size(), mend.find('?') - question.size());
    const bool is_word = !word.empty() && word.find_first_of(" ,;()\"") == std::string_view::npos;
    return is_word ? std::optional(std::string(word)) : std::nullopt;
  }
  constexpr std::string_view before_list = " are ";
  const auto list = mend.find(before_list);
  if (list == std::string_view::npos) {
    return std::nullopt;
  }
  std::vector<std::string> names;
  std::string_view rest = mend.substr(list + before_list.size());
  rest = rest.substr(0, rest.find('.'));
  while (!rest.empty()) {
    const auto comma = rest.find(", ");
    names.emplace_back(rest.substr(0, comma));
    rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 2);
  }
  const auto near = nearest_name(written, names);
  return near.empty() ? std::nullopt : std::optional(std::string(near));
}

}  // namespace hysteron::lsp
