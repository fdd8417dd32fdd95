#include "fleet/store.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <system_error>

#include "database/sqlite.hpp"
#include "fleet/run_record.hpp"
#include "support/diagnostic.hpp"
#include "support/errors.hpp"

namespace hysteron::fleet {
namespace {

namespace fs = std::filesystem;
using database::Database;
using database::Statement;

constexpr const char* tables = R"sql(
CREATE TABLE runs (
  id TEXT PRIMARY KEY, manifest TEXT NOT NULL, version TEXT NOT NULL, options TEXT NOT NULL, last TEXT NOT NULL,
  is_current INTEGER NOT NULL);
CREATE TABLE units (
  key TEXT PRIMARY KEY, machine TEXT NOT NULL, recorded TEXT NOT NULL, time REAL, machine_group TEXT NOT NULL,
  command TEXT NOT NULL, diagram TEXT NOT NULL, params TEXT NOT NULL, log TEXT NOT NULL, version TEXT NOT NULL,
  status TEXT NOT NULL, verdict TEXT NOT NULL, confidence REAL, nominal_rms REAL, improved_rms REAL,
  rms_unit TEXT NOT NULL, reason TEXT NOT NULL, exit_code INTEGER, seconds REAL, folder TEXT NOT NULL);
CREATE TABLE run_units (
  run TEXT NOT NULL REFERENCES runs, line INTEGER NOT NULL, unit TEXT NOT NULL REFERENCES units,
  PRIMARY KEY (run, unit));
CREATE TABLE effects (
  unit TEXT NOT NULL REFERENCES units, effect TEXT NOT NULL, family TEXT NOT NULL, edge TEXT NOT NULL,
  probability REAL, share REAL, is_named INTEGER NOT NULL);
CREATE TABLE parameters (
  unit TEXT NOT NULL REFERENCES units, source TEXT NOT NULL, name TEXT NOT NULL, value REAL, standard_error REAL,
  low REAL, high REAL, unit_of_measure TEXT NOT NULL, at_bound TEXT NOT NULL);
CREATE INDEX units_of_machine ON units (machine, time);
CREATE INDEX effects_of_unit ON effects (unit);
CREATE INDEX parameters_of_unit ON parameters (unit);
CREATE VIEW current_units AS SELECT units.*, run_units.line FROM units
  JOIN run_units ON run_units.unit = units.key JOIN runs ON runs.id = run_units.run WHERE runs.is_current = 1;
)sql";

class Writer {
 public:
  explicit Writer(Database& database)
      : run_(database.prepared("INSERT INTO runs VALUES (?, ?, ?, ?, ?, ?)")),
        unit_(
            database.prepared("INSERT INTO units VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")),
        member_(database.prepared("INSERT INTO run_units VALUES (?, ?, ?)")),
        effect_(database.prepared("INSERT INTO effects VALUES (?, ?, ?, ?, ?, ?, ?)")),
        parameter_(database.prepared("INSERT INTO parameters VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)")) {}

  void write(const Run& run, bool is_current) {
    run_.bind(1, run.id)
        .bind(2, run.manifest)
        .bind(3, run.version)
        .bind(4, fmt::format("{}", fmt::join(run.options, " ")))
        .bind(5, run.last)
        .bind(6, std::int64_t{is_current ? 1 : 0})
        .run();
  }

  void write(const Row& row, const std::string& version) {
    const Unit& unit = row.unit;
    unit_.bind(1, row.key)
        .bind(2, unit.machine)
        .bind(3, unit.when)
        .bind(4, unit.time)
        .bind(5, unit.group)
        .bind(6, name_of(unit.command))
        .bind(7, unit.diagram)
        .bind(8, unit.parameters)
        .bind(9, unit.log)
        .bind(10, version)
        .bind(11, name_of(row.result.status))
        .bind(12, row.outcome.verdict)
        .bind(13, row.outcome.confidence)
        .bind(14, row.outcome.nominal_rms)
        .bind(15, row.outcome.improved_rms)
        .bind(16, row.outcome.unit_of_gap)
        .bind(17, row.result.reason)
        .bind(18, std::int64_t{row.result.exit_code})
        .bind(19, row.result.seconds)
        .bind(20, folder_of("", row.key).string());
    if (row.result.status == Status::Open) {
      unit_.bind_null(18).bind_null(19);
    }
    unit_.run();
    for (const FoundEffect& one : row.outcome.effects) {
      effect_.bind(1, row.key)
          .bind(2, one.effect)
          .bind(3, one.family)
          .bind(4, one.edge)
          .bind(5, one.probability)
          .bind(6, one.share)
          .bind(7, std::int64_t{one.named ? 1 : 0})
          .run();
    }
    for (const FoundParameter& one : row.outcome.parameters) {
      parameter_.bind(1, row.key)
          .bind(2, one.source)
          .bind(3, one.name)
          .bind(4, one.value)
          .bind(5, one.standard_error)
          .bind(6, one.low)
          .bind(7, one.high)
          .bind(8, one.unit)
          .bind(9, one.at_bound)
          .run();
    }
  }

  void write_member(const Run& run, std::size_t i) {
    member_.bind(1, run.id).bind(2, std::int64_t{run.units[i].line}).bind(3, run.keys[i]).run();
  }

 private:
  Statement run_;
  Statement unit_;
  Statement member_;
  Statement effect_;
  Statement parameter_;
};

void write_rows(Database& database, const fs::path& output, const std::vector<Row>& known) {
  std::map<std::string, const Row*> rows;
  for (const Row& row : known) {
    rows[row.key] = &row;
  }
  const auto runs = read_runs(output);
  Writer writer(database);
  std::set<std::string> written;
  // From the last: what a unit's group is, and where its files are, the last manifest says.
  for (auto run = runs.rbegin(); run != runs.rend(); ++run) {
    writer.write(*run, run == runs.rbegin());
    for (std::size_t i = 0; i < run->keys.size(); ++i) {
      if (written.insert(run->keys[i]).second) {
        const auto there = rows.find(run->keys[i]);
        Row row = there != rows.end() ? *there->second : rows_of({run->units[i]}, {run->keys[i]}, output).front();
        row.unit = run->units[i];
        writer.write(row, run->version);
      }
      writer.write_member(*run, i);
    }
  }
}

}  // namespace

void write_store(const fs::path& output, const std::vector<Row>& known) {
  const fs::path making = output / "work" / "fleet.sqlite";
  const auto fail = [&](const std::exception& problem) {
    throw InputError(error::unwritable_file, {.file = (output / "fleet.sqlite").string()},
                     fmt::format("the database cannot be written: {}.", problem.what()),
                     "make room or permit writing, and run the same command again; what is done stays.");
  };
  try {
    fs::create_directories(making.parent_path());
    for (const char* const behind : {"", "-journal", "-wal", "-shm"}) {
      fs::remove(making.string() + behind);  // of a writer that was killed
    }
    {
      Database database(making, Database::Mode::Write);
      database::Transaction all(database);
      database.run(tables);
      database.set_version(store_version);
      write_rows(database, output, known);
      all.commit();
      // One file, which can be copied, and read where nothing may be written.
      database.run("PRAGMA journal_mode = DELETE");
    }
    fs::rename(making, output / "fleet.sqlite");
  } catch (const database::DatabaseError& problem) {
    fail(problem);
  } catch (const fs::filesystem_error& problem) {
    fail(problem);
  }
}

}  // namespace hysteron::fleet
