// Rows and terms as text: which of them are alike, and the loops over them.
//
// A loop over rows computes several rows at once, each in variables of its own. A sum keeps its order, and a processor
// that adds while it still waits for another sum needs not wait (decision 48).
#include <algorithm>

#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/backends/shared/step_writer.hpp"

namespace hysteron {
namespace {

/// A text without the brackets that stand round the whole of it.
std::string_view without_brackets(std::string_view text) {
  if (!text.starts_with('(')) {
    return text;
  }
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    depth += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
    if (depth == 0 && i + 1 < text.size()) {
      return text;
    }
  }
  return text.substr(1, text.size() - 2);
}

}  // namespace

std::vector<StepWriter::TermText> StepWriter::terms_of(ValueId sum) const {
  std::vector<TermText> texts;
  for (const ValueShapes::Term& term : shapes_.terms(routine, sum)) {
    expressions.print_added(term.value, texts.emplace_back(TermText{.text = {}, .minus = term.minus}).text);
  }
  return texts;
}

std::vector<StepWriter::TermRun> StepWriter::runs_of(const std::vector<TermText>& terms, std::size_t shortest) {
  std::vector<TermRun> runs;
  for (std::size_t i = 0; i < terms.size();) {
    const TermRun single{.pattern = PlacePattern(terms[i].text), .first = i, .minus = terms[i].minus};
    TermRun run = single;
    while (i + run.count < terms.size() && terms[i + run.count].minus == run.minus &&
           run.pattern.takes(terms[i + run.count].text, 0, run.count)) {
      ++run.count;
    }
    if (run.count < shortest) {
      run = single;
    }
    i += run.count;
    runs.push_back(std::move(run));
  }
  return runs;
}

StepWriter::RowLoop StepWriter::loop_from(std::span<const RowText> rows) const {
  RowLoop loop{
      .line = PlacePattern(rows.front().line), .terms = runs_of(rows.front().terms, shortest_sum()), .count = 1};
  const auto fits = [&](const RowText& row, std::size_t at) {
    return row.terms.size() == rows.front().terms.size() && loop.line.takes(row.line, at, 0) &&
           std::ranges::all_of(loop.terms, [&](TermRun& run) {
             for (std::size_t i = 0; i < run.count; ++i) {
               const TermText& term = row.terms[run.first + i];
               if (term.minus != run.minus || !run.pattern.takes(term.text, at, i)) {
                 return false;
               }
             }
             return true;
           });
  };
  while (loop.count < rows.size() && fits(rows[loop.count], loop.count)) {
    ++loop.count;
  }
  return loop;
}

std::size_t StepWriter::rows_at_once(const RowLoop& loop) const {
  if (!loops_->several_at_once || loop.terms.empty()) {
    return 1;
  }
  return has_loop(loop.terms) ? looped_rows_at_once : written_rows_at_once;
}

void StepWriter::write_loop(const RowLoop& loop, std::span<const Row> rows, std::string& text) {
  const std::size_t width = rows.front().reads_last ? 1 : rows_at_once(loop);
  const std::size_t whole = rows.size() - rows.size() % width;
  std::size_t done = 0;
  if (whole > width) {
    begin_line(text);
    begin_loop(loops_->places.row, 0, whole, width, text);
    const std::string_view outside = indentation;
    indentation = texts_.emplace_back(std::string(outside) + "  ");
    std::vector<std::string_view> sums(loops_->sums.begin(), loops_->sums.begin() + static_cast<std::ptrdiff_t>(width));
    write_block(loop, 0, sums, loops_->places.row, text);
    indentation = outside;
    text += indentation;
    end_loop(text);
    done = whole;
  }
  while (done < rows.size()) {
    const std::size_t count = std::min(width, rows.size() - done);
    if (count == 1 || !has_loop(loop.terms)) {
      for (const Row& row : rows.subspan(done, count)) {
        write_row(row, text);
      }
    } else {
      std::vector<std::string_view> sums;
      for (const Row& row : rows.subspan(done, count)) {
        sums.push_back(name_of_sum(row));
      }
      write_block(loop, done, sums, {}, text);
    }
    done += count;
  }
}

/// Rows side by side: first their sums, then their lines.
void StepWriter::write_block(const RowLoop& loop, std::size_t first, std::span<const std::string_view> sums,
                             std::string_view row, std::string& text) {
  if (!loop.terms.empty()) {
    std::vector<Sum> list;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      list.push_back({.name = sums[i], .runs = loop.terms});
      for (TermRun& run : list.back().runs) {
        run.pattern = run.pattern.after_rows(first + i);
      }
    }
    write_sums(list, row, text);
  }
  PlaceWords words = loops_->places;
  words.row = row;
  words.column = {};
  for (std::size_t i = 0; i < sums.size(); ++i) {
    std::string sum;
    print_variable(sums[i], sum);
    append(text, indentation, loop.line.after_rows(first + i).text(words, sum));
  }
}

/// Variables become sums from the left, side by side. Their terms are alike.
void StepWriter::write_sums(std::span<const Sum> sums, std::string_view row, std::string& text) {
  PlaceWords first = loops_->places;
  first.row = row;
  first.column = {};
  PlaceWords each = first;
  each.column = loops_->places.column;

  const std::vector<TermRun>& runs = sums.front().runs;
  const bool stands_alone = runs.size() == 1 || runs[0].count > 1 || runs[1].count > 1;
  std::vector<std::string> variables(sums.size());
  std::vector<std::string> open(sums.size());  // the lines to be written next, without their end
  begin_section(text);
  for (std::size_t s = 0; s < sums.size(); ++s) {
    print_variable(sums[s].name, variables[s]);
    begin_variable(sums[s].name, {.is_known = sums[s].is_known, .changes = has_loop(runs)}, open[s]);
    const std::string begin = sums[s].runs.front().pattern.text(first);
    append(open[s], loops_->assign, stands_alone ? without_brackets(begin) : begin);
  }
  const auto close_lines = [&] {
    for (std::string& line : open) {
      if (!line.empty()) {
        append(text, indentation, line, ";\n");
        line.clear();
      }
    }
  };
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (runs[i].count > 1) {
      close_lines();
      text += indentation;
      begin_loop(each.column, i == 0 ? 1 : 0, runs[i].count, 1, text);
    }
    for (std::size_t s = 0; s < sums.size(); ++s) {
      if (runs[i].count > 1) {
        append(text, indentation, "  ", variables[s], loops_->assign, variables[s], runs[i].sign(),
               sums[s].runs[i].pattern.text(each), ";\n");
      } else if (i > 0) {
        if (open[s].empty()) {
          append(open[s], variables[s], loops_->assign, variables[s]);
        }
        append(open[s], runs[i].sign(), sums[s].runs[i].pattern.text(first));
      }
    }
    if (runs[i].count > 1) {
      text += indentation;
      end_loop(text);
    }
  }
  close_lines();
}

}  // namespace hysteron
