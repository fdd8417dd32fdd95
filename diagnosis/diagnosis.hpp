// What a diagnosis answers: the verdict, the effects with their parameters, and all that the report shows of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codegen/parameters/parameter_file.hpp"
#include "diagnosis/effects/candidates.hpp"
#include "diagnosis/evidence/law_findings.hpp"
#include "diagnosis/noise/noise_floor.hpp"
#include "diagnosis/rules.hpp"
#include "tuning/friction_curves.hpp"

namespace hysteron::diagnosis {

enum class Verdict : std::uint8_t { None, Calibration, Named, Group, Partial, Unknown };

[[nodiscard]] std::string_view name_of(Verdict verdict);

/// A parameter of an effect, with its 95 % interval.
struct ParameterFinding {
  std::string name{};
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
  std::string unit{};
  FieldRole role = FieldRole::Number;
};

/// What an effect was given and no fit moved: the distance at which a nonlinearity has its size, a stride.
struct SettingFinding {
  std::string name{};
  double value = 0.0;
  std::string unit{};
};

/// Whether a feedforward can take an effect back.
enum class Inverse : std::uint8_t { Exact, Avoidable, None };

struct EffectFinding {
  std::string id{};
  std::string family{};  ///< dry_friction; of an effect without one, its id
  std::string edge{};
  std::vector<std::string> same_edges{};  ///< edges that this record cannot tell from it
  std::vector<std::string> drivers{};     ///< signals that drive it, besides that of its edge
  double share = 0.0;                     ///< of the gap that calibration leaves, with the glitches in it
  /// In the loop around a plant that was weighed alone: its share is of the gap at the outputs, and no part of what the
  /// plant lacks, as the others' are.
  bool around_plant = false;
  Inverse inverse = Inverse::None;
  std::vector<ParameterFinding> parameters{};
  std::vector<SettingFinding> settings{};
};

/// A set of effects that the data do not rule out.
struct Rival {
  std::vector<std::string> effects{};
  std::vector<std::string> edges{};  ///< of each effect, beside it
  std::size_t parameters = 0;        ///< that the effects bring, all together
  double improved_rms = 0.0;         ///< of the output whose gap counts, in its unit; NaN: that set was not kept
  double support = 0.0;              ///< log likelihood less that of the best, 0 or below
  double probability = 0.0;
};

/// What an improved diagram will leave of a further record of the machine, RMS with its 95 % interval.
struct NextRecord {
  double rms = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// From where to where an input went while the machine was recorded.
struct InputRange {
  std::string signal{};
  std::string unit{};
  double low = 0.0;
  double high = 0.0;
};

/// The gap of one output, RMS in its unit.
struct GapFinding {
  std::string signal{};
  std::string unit{};
  double nominal = 0.0;
  double calibrated = 0.0;
  double improved = 0.0;
  NoiseFloor floor{};
  double closed = 0.0;  ///< of the gap between nominal and floor, on held-out blocks
  double closed_low = 0.0;
  double closed_high = 0.0;
  std::optional<NextRecord> next{};
};

struct EdgeFinding {
  std::string edge{};
  double share = 0.0;                ///< of the gap, that test signals on this edge span or an effect there closes
  std::vector<std::string> group{};  ///< edges that the record cannot tell from it
};

/// A measured inner signal, which cuts the diagram: where it agrees with its column the gap lies behind it.
struct CutFinding {
  std::string signal{};
  bool agrees = false;
};

/// Shares of the gap that calibration leaves, by where they arise.
struct GapSplit {
  double input_output = 0.0;  ///< delay, clock, quantum and glitches on the wires that a record is made of
  double plant = 0.0;         ///< all other effects
  double open = 0.0;          ///< what no effect closes
};

/// What the replay of a runtime's trace says of the deployed controller; filled in by who has the trace.
struct ControllerFinding {
  struct Output {
    std::string name{};
    std::string unit{};
    double difference_rms = 0.0;  ///< as recorded less as the controller's diagram computes it
    double limited_rms = 0.0;     ///< as it left less as computed: limits and safe values
  };
  std::uint64_t steps = 0;
  std::uint64_t different = 0;  ///< steps with other bits
  std::uint64_t first_different = 0;
  std::uint64_t dropped = 0;  ///< steps that are missing in the trace
  std::vector<Output> outputs{};
};

/// Where a residual depends on something: its mean or size in bins of it.
struct MapFinding {
  std::string over{};  ///< "amplitude", "rate", "depth", …
  std::string unit{};
  std::vector<double> places{};  ///< of the bins
  std::vector<double> before{};  ///< RMS of the calibrated residual there
  std::vector<double> after{};   ///< of the improved one
  std::vector<double> mean{};    ///< mean of the calibrated residual
  double share = 0.0;            ///< of the residual's variance that its mean over the bins explains
};

/// One signal over one record, for plots.
struct Trace {
  /// The input that it is drawn over where a hysteresis or a play lies between them; of no name: none.
  struct Over {
    std::string name{};
    std::string unit{};
    std::vector<double> values{};
  };
  std::string record{};
  std::string signal{};
  std::string unit{};
  std::vector<double> time{};
  std::vector<double> measured{};
  std::vector<double> nominal{};
  std::vector<double> calibrated{};
  std::vector<double> improved{};
  Over over{};
};

/// What the swing of a control loop says of its valve, where a controller sets the input of the diagram.
struct LoopFinding {
  std::string input{};
  std::string output{};
  double feedback = 0.0;  ///< of what the input's own past does not tell, the share that follows from the output
  double oddness = 0.5;   ///< of the energy of their cross-correlation, the share that is odd about lag 0
};

/// What would tell the rivals apart best, or show a single cause best.
struct NextExperiment {
  /// An input of the diagram that rests meanwhile.
  struct Resting {
    std::string input{};
    std::string unit{};
    double value = 0.0;
  };
  std::string title{};   ///< empty where no experiment would tell
  std::string reason{};  ///< why it is recommended, or why none is
  std::string input{};
  std::string unit{};
  double separation = 0.0;  ///< RMS between the rivals' outputs over the noise; of one cause alone, its own part
  std::vector<double> time{};
  std::vector<double> values{};
  std::vector<Resting> resting{};
  std::vector<std::pair<std::string, std::string>> steps{};  ///< the command table: what, how long
};

struct Diagnosis {
  Verdict verdict = Verdict::Unknown;
  std::string summary{};                ///< the verdict in plain words
  std::vector<std::string> refusals{};  ///< why the record could not be diagnosed; empty where it could
  std::vector<std::string> warnings{};
  std::vector<EffectFinding> effects{};
  std::vector<ParameterFinding> calibration{};  ///< known parameters, as refitted
  std::vector<ParameterFinding> nominal{};      ///< as they were given
  std::vector<Rival> rivals{};
  std::size_t siblings = 0;           ///< that the probabilities of the evidence take into account
  Evidence evidence{};                ///< where effects leave more than noise: what is there, by families
  std::optional<GapBudget> budget{};  ///< of which kind the gap is; empty where there is none
  std::optional<LoopFinding> loop{};  ///< where the record is of a control loop
  std::vector<Rival> fitted{};        ///< the best of all sets that were fitted, ruled out or not
  double confidence = 0.0;
  double unknown_score = 0.0;
  GapFinding gap{};                ///< of the output with the largest gap over its floor
  std::vector<GapFinding> gaps{};  ///< of all outputs
  std::vector<InputRange> inputs{};
  std::vector<EdgeFinding> edges{};
  std::vector<CutFinding> cuts{};
  GapSplit split{};
  std::optional<ControllerFinding> controller{};
  std::vector<MapFinding> maps{};
  std::vector<std::string> cannot_tell{};
  NextExperiment next{};
  std::vector<Trace> traces{};
  std::vector<FrictionCurve> frictions{};        ///< of the improved diagram, over the first record
  std::string top{};                             ///< the diagram's top block
  std::string improved_text{};                   ///< the diagram with the effects, formatted
  parameters::ParameterFile improved_file{};     ///< its parameters
  std::string feedforward_text{};                ///< where the improved diagram has an inverse, else empty
  std::vector<std::string> feedforward_notes{};  ///< how exact it is, or why there is none
  double tracking_nominal = 0.0;      ///< predicted RMS tracking error with the nominal diagram's feedforward
  double tracking_improved = 0.0;     ///< and with that of the improved one; both 0 where there is none
  std::vector<Decision> decisions{};  ///< the answers of the rules, where they were asked for
  std::size_t tried = 0;
  std::uint64_t work = 0;  ///< of the search, in block steps: the same on every machine
  double seconds = 0.0;
};

}  // namespace hysteron::diagnosis
