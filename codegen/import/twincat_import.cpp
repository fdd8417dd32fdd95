#include "codegen/import/twincat_import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <vector>

#include "codegen/import/global_list.hpp"
#include "codegen/language/annotation.hpp"
#include "codegen/language/lexer.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/trimmed.hpp"

namespace hysteron {

using language::Symbol;

namespace {

/// A word of a text outside of comments, pragmas and strings.
struct TextWord {
  std::string_view text{};
  std::size_t begin = 0;
  std::size_t end = 0;  ///< where it ends in the text
  Symbol before = Symbol::End;
  Symbol behind = Symbol::End;
};

std::vector<TextWord> words_of_text(std::string_view text) {
  language::Lexer lexer(text, language::Comments::Annotated, nullptr);
  lexer.take_foreign();
  std::vector<TextWord> words;
  Symbol before = Symbol::End;
  bool is_behind_word = false;
  for (language::Token one = lexer.next(); one.symbol != Symbol::End; one = lexer.next()) {
    if (is_behind_word) {
      words.back().behind = one.symbol;
    }
    is_behind_word = one.symbol == Symbol::Identifier || one.symbol == Symbol::Keyword || one.symbol == Symbol::Typed;
    if (is_behind_word) {
      const std::string_view word = text.substr(one.offset, one.length);
      words.push_back({word.substr(0, word.find('#')), one.offset, one.end(), before});  // STATE#IDLE names STATE
    }
    before = one.symbol;
  }
  return words;
}

class TwincatImport {
 public:
  TwincatImport(const FindObject& find, const ImportOptions& options) : find_(find), options_(options) {}

  std::string run(const ProjectFile& file) {
    add(file, true);
    if (refused_.has_errors()) {
      throw InputError(std::move(refused_));
    }
    return text_;
  }

 private:
  /// Objects name each other in depth; a project that names them in a circle is told by the check of the text.
  void add(const ProjectFile& file, bool is_first) {
    pugi::xml_document document;
    const auto result = document.load_buffer(file.text.data(), file.text.size());
    const pugi::xml_node root = document.child("TcPlcObject");
    if (!result || !root) {
      throw InputError(error::not_plcopen, {.file = file.path, .line = 1, .column = 1},
                       result ? "there is no TcPlcObject in it"
                              : fmt::format("the XML ends being XML here: {}", result.description()),
                       "Save the object in TwinCAT again; the file may have been cut.");
    }
    for (const pugi::xml_node object : root.children()) {
      const std::string_view kind = object.name();
      if (kind == "POU") {
        add_pou(file, object, is_first);
      } else if (kind == "DUT") {
        const std::string declaration = object.child_value("Declaration");
        add_needed(declaration, object.attribute("Name").value());
        append(without_lists(declaration));
      } else if (kind == "GVL" || kind == "Itf") {
        refuse(file, object,
               fmt::format("{} is {}", object.attribute("Name").value(),
                           kind == "GVL" ? "a list of global variables" : "an interface"),
               kind == "GVL" ? "Import a block that names its variables: they come with it."
                             : "A diagram has no objects: take the block itself.");
      }
    }
  }

  void add_pou(const ProjectFile& file, const pugi::xml_node& pou, bool is_first) {
    const std::string name = pou.attribute("Name").value();
    for (const char* const part : {"Method", "Property", "Action", "Transition"}) {
      for (const pugi::xml_node one : pou.children(part)) {
        refuse(file, one, fmt::format("{} has the {} {}", name, in_capitals(part), one.attribute("Name").value()),
               "A block has one body here: write these statements into it, or into a FUNCTION.");
      }
    }
    const pugi::xml_node body = pou.child("Implementation").first_child();
    if (!body.empty() && std::string_view(body.name()) != "ST") {
      refuse(file, body, fmt::format("the body of {} is written in {}", name, body.name()),
             "Only ST is read from a .TcPOU. Export networks as PLCopen XML, or let the editor turn them into ST.");
      return;
    }
    std::string declaration = pou.child_value("Declaration");
    std::string statements = body.child_value();
    const std::vector<TextWord> words = words_of_text(declaration);
    const auto is_kind = [](const TextWord& word) {
      return equal_ignoring_case(word.text, "FUNCTION_BLOCK") || equal_ignoring_case(word.text, "FUNCTION") ||
             equal_ignoring_case(word.text, "PROGRAM");
    };
    const auto kind = std::ranges::find_if(words, is_kind);
    const auto its_name =
        std::find_if(kind, words.end(), [&](const TextWord& word) { return equal_ignoring_case(word.text, name); });
    if (its_name == words.end() || equal_ignoring_case(kind->text, "PROGRAM")) {
      refuse(file, pou,
             its_name == words.end() ? fmt::format("{} is not declared in its own file", name)
                                     : fmt::format("{} is a PROGRAM", name),
             "Import a FUNCTION_BLOCK, or a FUNCTION.");
      return;
    }
    add_needed(declaration + "\n" + statements, name);
    refuse_hidden(file, pou, declaration, declaration + "\n" + statements);
    const std::string ending = "END_" + in_capitals(kind->text);
    if (equal_ignoring_case(kind->text, "FUNCTION_BLOCK")) {
      annotate(declaration, its_name->end, is_first ? options_.cycle : "");
    }
    append(without_lists(declaration + "\n" + statements) + "\n" + ending);
  }

  /// Behind the name of a block: that its text is a body, and its sample time. A text of our own says both already.
  static void annotate(std::string& declaration, std::size_t place, const std::string& cycle) {
    std::string kept;
    const std::size_t begin = declaration.find_first_not_of(" \t\r\n", place);
    const std::size_t end = declaration.find("*)", begin);
    if (end != std::string::npos && declaration.compare(begin, 2, "(*") == 0) {
      const language::Span comment{static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end + 2 - begin)};
      const auto own = language::annotations_of(declaration, comment);
      const std::string_view text(declaration);
      if (!own.empty() && own.front().span.offset == text.find_first_not_of(' ', begin + 2)) {
        for (std::size_t i = 0; i < own.size(); ++i) {
          const language::Span& one = own[i].span;
          const bool stated = own[i].key == "body" || (own[i].key == "ts" && !cycle.empty());
          const std::size_t from = stated ? one.offset + one.length : one.offset;
          const std::size_t next = i + 1 < own.size() ? own[i + 1].span.offset : end;
          const std::string_view rest = trimmed(text.substr(from, next - from), " \t\r\n");
          kept += (rest.empty() ? "" : " ") + std::string(rest);
        }
        declaration.erase(place, end + 2 - place);
      }
    }
    declaration.insert(place, fmt::format(" (*{} @body{} *)", cycle.empty() ? "" : " @ts " + cycle, kept));
  }

  /// What a text names and the project has, before the text itself.
  void add_needed(const std::string& text, const std::string& own) {
    added_.insert(in_capitals(own));
    const std::vector<TextWord> words = words_of_text(text);
    for (std::size_t i = 0; i < words.size(); ++i) {
      const std::string name = in_capitals(words[i].text);
      if (words[i].before == Symbol::Dot) {
        continue;  // a member
      }
      if (const GlobalList* const list = list_of(words[i])) {
        if (i + 1 < words.size()) {
          add_variable(name, *list, in_capitals(words[i + 1].text));
        }
      } else if (added_.insert(name).second) {
        const auto file = find_(words[i].text);
        if (const auto variables = file ? global_list_of(file->text) : std::nullopt) {
          add_variable(file->path, *variables, name);
        } else if (file) {
          add(*file, false);
        }
      }
    }
  }

  /// The list that a word names, where a point and one of its variables stand behind it; null where it names none.
  const GlobalList* list_of(const TextWord& word) {
    if (word.behind != Symbol::Dot || word.before == Symbol::Dot) {
      return nullptr;
    }
    const auto [found, is_new] = lists_.try_emplace(in_capitals(word.text));
    if (is_new) {
      const auto file = find_(word.text);
      found->second = file ? global_list_of(file->text) : std::nullopt;
    }
    return found->second ? &*found->second : nullptr;
  }

  void add_variable(const std::string& list, const GlobalList& variables, const std::string& name) {
    const GlobalVariable* const variable = variables.find(name);
    if (variable == nullptr || !variables_.emplace(name, variable->text).second) {
      return;
    }
    for (const std::string& other : variable->names) {
      variables_.emplace(other, variable->text);
    }
    add_needed(variable->text, list + "." + name);
    append(without_lists(variable->text));
  }

  /// LIST.NAME is NAME: its list comes with the text.
  std::string without_lists(std::string text) {
    const std::vector<TextWord> words = words_of_text(text);
    for (std::size_t i = words.size(); i-- > 1;) {
      if (list_of(words[i - 1]) != nullptr) {
        text.erase(words[i - 1].begin, words[i].begin - words[i - 1].begin);
      }
    }
    return text;
  }

  /// A variable of a list that a block names by it, and that would be another one without.
  void refuse_hidden(const ProjectFile& file, const pugi::xml_node& pou, const std::string& declaration,
                     const std::string& text) {
    std::set<std::string> own;
    for (const TextWord& word : words_of_text(declaration)) {
      if (word.behind == Symbol::Colon || word.behind == Symbol::Comma) {
        own.insert(in_capitals(word.text));
      }
    }
    const std::vector<TextWord> words = words_of_text(text);
    for (std::size_t i = 1; i < words.size(); ++i) {
      const GlobalList* const list = list_of(words[i - 1]);
      const std::string name = in_capitals(words[i].text);
      const GlobalVariable* const variable = list == nullptr ? nullptr : list->find(name);
      const bool is_another = variable != nullptr && variables_.at(name) != variable->text;
      if (is_another || (variable != nullptr && own.contains(name))) {
        refuse(file, pou,
               fmt::format("{}.{} has the name of another variable {}", words[i - 1].text, words[i].text,
                           is_another ? "in another list" : fmt::format("of {}", pou.attribute("Name").value())),
               "Give one of the two another name: a text here has one place for names.");
      }
    }
  }

  void append(std::string text) {
    std::erase(text, '\r');
    const std::size_t end = text.find_last_not_of(" \t\n");
    text_ += (text_.empty() ? "" : "\n") + text.substr(0, end == std::string::npos ? 0 : end + 1) + "\n";
  }

  void refuse(const ProjectFile& file, const pugi::xml_node& node, std::string cause, std::string mend) {
    const auto offset = static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0));
    const auto lines = std::count(
        file.text.begin(), file.text.begin() + static_cast<std::ptrdiff_t>(std::min(offset, file.text.size())), '\n');
    refused_.error(error::untranslatable_element,
                   {.file = file.path, .line = static_cast<std::uint32_t>(lines + 1), .column = 1}, std::move(cause),
                   std::move(mend));
  }

  const FindObject& find_;
  const ImportOptions& options_;
  Diagnostics refused_;
  std::map<std::string, std::optional<GlobalList>> lists_;  ///< by what may be the name of one, in capitals
  std::map<std::string, std::string> variables_;            ///< of lists, by name in capitals: their text
  std::set<std::string> added_;                             ///< names that were looked for, in capitals
  std::string text_;
};

}  // namespace

bool is_twincat_object(std::string_view text) {
  return text.substr(0, 1000).find("<TcPlcObject") != std::string_view::npos;
}

std::string import_twincat(const ProjectFile& file, const FindObject& find, const ImportOptions& options) {
  return TwincatImport(find, options).run(file);
}

}  // namespace hysteron
