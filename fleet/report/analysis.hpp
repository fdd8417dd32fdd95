// What the results of a fleet say of its machines: which drift, and which stand out from their siblings.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fleet/report/trend.hpp"
#include "fleet/table.hpp"

namespace hysteron::fleet {

/// Machines of one kind are siblings: those of a group, or of a diagram where the manifest has no groups.
struct Kind {
  std::string group{};
  Command command = Command::Diagnose;
};
[[nodiscard]] Kind kind_of(const Unit& unit);

/// A parameter over all machines of a kind.
struct Parameter {
  Kind kind{};
  std::string name{};
  std::string unit{};
  std::vector<std::size_t> tracks{};
  double median = not_a_number;     ///< over machines, of their medians over records
  double deviation = not_a_number;  ///< 1.4826 · MAD of the same; not a number for fewer than `least_siblings` machines
  Scatter scatter{};                ///< from record to record
};

/// A parameter of a machine.
struct Track {
  std::string machine{};
  std::size_t parameter = 0;
  std::vector<std::size_t> rows{};  ///< of its records, in the order of time; those without a time first
  std::vector<double> value{};      ///< of each
  std::vector<double> error{};      ///< standard deviation by the fit; not a number where it is not known
  Series series{};                  ///< those with a time
  double level = not_a_number;      ///< median over its records
  Trend trend{};
  bool has_trend = false;  ///< a trend could be asked
  double sibling_p = 1.0;  ///< of a distance from its siblings as large by chance
  bool has_siblings = false;
  bool changes = false;     ///< a finding
  bool stands_out = false;  ///< a finding
};

/// An effect that is named in records of a machine.
struct Presence {
  std::string machine{};
  Kind kind{};
  std::string effect{};  ///< `backlash at Y`
  std::size_t named = 0;
  std::size_t records = 0;
  double since = not_a_number;  ///< the record from which on it is named; not a number where it always was
  double sibling_share = 0.0;   ///< of the siblings' records that name it
  double p = 1.0;               ///< of being named so often at the siblings' share
  bool has_siblings = false;
  bool stands_out = false;
};

/// Fewer siblings have no median that one of them could stand out from.
inline constexpr std::size_t least_siblings = 5;

struct Finding {
  enum class What { Change, Level, Effect };
  What what = What::Change;
  std::size_t index = 0;  ///< of the track, or of the presence
  std::string machine{};
  double p = 1.0;
};

struct Analysis {
  double false_share = 0.05;
  std::vector<std::string> machines{};  ///< in the order of the manifest
  std::vector<Parameter> parameters{};
  std::vector<Track> tracks{};
  std::vector<Presence> presences{};
  std::vector<std::size_t> failures{};  ///< rows without a result
  std::vector<Finding> findings{};      ///< of one machine together, the surest machine first
  std::size_t tests = 0;                ///< that were asked
  double threshold = -1.0;              ///< p of the last finding; negative where there is none
  std::size_t machines_found = 0;       ///< that drift or stand out
};

/// Asks every machine and parameter: a change by trend_of; a distance from the siblings' median over the larger of
/// their robust deviation and the machine's own error, by Student's distribution with 0.37·(machines − 1) degrees of
/// freedom (0.37 is the efficiency of the MAD, Rousseeuw and Croux 1993); and every effect that is named, by the
/// binomial distribution at its siblings' share. Findings are chosen over all of these by Benjamini and Hochberg, so
/// that on average at most `false_share` of them are false.
[[nodiscard]] Analysis analysed(const std::vector<Row>& rows, double false_share);

}  // namespace hysteron::fleet
