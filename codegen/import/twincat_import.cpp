#include "codegen/import/twincat_import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>
#include <set>
#include <vector>

#include "codegen/language/lexer.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron {
namespace {

/// A word of a text outside of comments, pragmas and strings.
struct TextWord {
  std::string_view text{};
  std::size_t end = 0;  ///< where it ends in the text
};

std::vector<TextWord> words_of_text(std::string_view text) {
  using language::Symbol;
  language::Lexer lexer(text, language::Comments::Annotated, nullptr);
  lexer.take_foreign();
  std::vector<TextWord> words;
  for (language::Token one = lexer.next(); one.symbol != Symbol::End; one = lexer.next()) {
    if (one.symbol == Symbol::Identifier || one.symbol == Symbol::Keyword || one.symbol == Symbol::Typed) {
      const std::string_view word = text.substr(one.offset, one.length);
      words.push_back({word.substr(0, word.find('#')), one.end()});  // STATE#IDLE names STATE
    }
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
        append(declaration);
      } else if (kind == "GVL" || kind == "Itf") {
        refuse(file, object,
               fmt::format("{} is {}", object.attribute("Name").value(),
                           kind == "GVL" ? "a list of global variables" : "an interface"),
               kind == "GVL" ? "Hand its variables over as inputs; write its constants into the block, as VAR CONSTANT."
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
    const std::string statements = body.child_value();
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
    const std::string ending = "END_" + in_capitals(kind->text);
    if (equal_ignoring_case(kind->text, "FUNCTION_BLOCK")) {
      const bool timed = is_first && !options_.cycle.empty();
      declaration.insert(its_name->end, timed ? fmt::format(" (* @ts {} @body *)", options_.cycle) : " (* @body *)");
    }
    append(declaration + "\n" + statements + "\n" + ending);
  }

  /// What a text names and the project has, before the text itself.
  void add_needed(const std::string& text, const std::string& own) {
    added_.insert(in_capitals(own));
    for (const TextWord& word : words_of_text(text)) {
      if (!added_.insert(in_capitals(word.text)).second) {
        continue;
      }
      if (const auto file = find_(word.text)) {
        add(*file, false);
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
  std::set<std::string> added_;  ///< names that were looked for, in capitals
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
