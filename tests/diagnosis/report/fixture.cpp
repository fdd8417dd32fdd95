#include "tests/diagnosis/report/fixture.hpp"

#include <algorithm>
#include <cmath>

namespace hysteron::diagnosis::fixture {
namespace {

constexpr const char* diagram = R"st(
FUNCTION_BLOCK STAGE
  VAR_INPUT V : LREAL; TEMPERATURE : LREAL; END_VAR
  VAR_OUTPUT Y : LREAL; END_VAR
  VAR HYST : HY_HYSTERESIS_RO := (C1 := 0.2, C2 := 0.01); CREEP : HY_CREEP := (GAIN := 0.021, T_ONSET := 0.1);
      BODY : HY_SECOND_ORDER := (T := 0.0004, ZETA := 0.05); EXPANSION : HY_LAG := (T1 := 40.0); END_VAR
  HYST(XIN := V);
  CREEP(XIN := HYST.XOUT);
  BODY(XIN := CREEP.XOUT);
  EXPANSION(XIN := TEMPERATURE);
  Y := BODY.XOUT + 0.011 * (EXPANSION.XOUT - 21.0);
END_FUNCTION_BLOCK

FUNCTION_BLOCK PIEZO_AXIS  (* @ts 1ms *)
  VAR_INPUT REF : LREAL; T_ROOM : LREAL; OFFSET : LREAL := 0.0; (* @param *) END_VAR
  VAR_OUTPUT Y : LREAL; U : LREAL; END_VAR
  VAR LAST : HY_DELAY; SUM : HY_INTEGRAL; KI : HY_GAIN := (K := 12.0); DRIVE : HY_LAG := (T1 := 0.002); AMPLIFIER : HY_GAIN := (K := 10.0);
      DELAY : HY_DEAD_TIME := (DEAD_TIME := 0.0031); PLANT : STAGE; SENSOR : HY_QUANTIZER := (QUANTUM := 0.004);
      LOST : HY_BACKLASH := (WIDTH := 0.08); END_VAR
  SUM(XIN := REF - LAST.XOUT);
  DRIVE(XIN := 0.4 * (REF - LAST.XOUT) + KI.XOUT + OFFSET);
  KI(XIN := SUM.XOUT);
  DELAY(XIN := DRIVE.XOUT);
  AMPLIFIER(XIN := DELAY.XOUT);
  PLANT(V := AMPLIFIER.XOUT, TEMPERATURE := T_ROOM);
  LOST(XIN := PLANT.Y);
  SENSOR(XIN := LOST.XOUT);
  LAST(XIN := SENSOR.XOUT);
  Y := SENSOR.XOUT;
  U := DRIVE.XOUT;
END_FUNCTION_BLOCK
)st";

/// The same numbers on every machine, evenly within ±1.
class Noise {
 public:
  double operator()() {
    state_ = state_ * 1664525U + 1013904223U;
    return static_cast<double>(state_) / 2147483648.0 - 1.0;
  }

 private:
  std::uint32_t state_ = 7;
};

Trace trace_of(const char* record, const char* signal, const char* unit, std::size_t samples, double size) {
  Trace trace{.record = record, .signal = signal, .unit = unit};
  Noise noise;
  for (std::size_t k = 0; k < samples; ++k) {
    const double t = 0.001 * static_cast<double>(k);
    const double clean = size * (std::sin(7.0 * t) * (0.4 + 0.12 * t) + 0.2 * std::sin(1.9 * t));
    const double creep = size * 0.021 * std::log10(1.0 + t / 0.1);
    const double lost = size * 0.012 * std::tanh(30.0 * std::cos(7.0 * t));
    const double scale = size * 0.03 * std::sin(7.0 * t);
    trace.time.push_back(t);
    trace.measured.push_back(clean + size * 0.0016 * (noise() + noise() + noise()));
    trace.nominal.push_back(clean - creep - lost - scale);
    trace.calibrated.push_back(clean - creep - lost);
    trace.improved.push_back(clean - 0.04 * creep - 0.07 * lost);
  }
  return trace;
}

MapFinding map_of(const char* over, const char* unit, double first, double last, bool by_decades, double share) {
  MapFinding map{.over = over, .unit = unit, .share = share};
  for (int i = 0; i < 14; ++i) {
    const double s = static_cast<double>(i) / 13.0;
    map.places.push_back(by_decades ? first * std::pow(last / first, s) : first + (last - first) * s);
    map.before.push_back(0.06 + 0.24 * share * s * s + 0.02 * std::sin(9.0 * s));
    map.after.push_back(0.017 + 0.004 * std::sin(5.0 * s));
    map.mean.push_back(share * (0.2 * s - 0.06));
  }
  return map;
}

std::vector<EdgeFinding> edges() {
  return {{"PLANT.HYST.XOUT", 0.91, {"PLANT.BODY.XOUT"}},
          {"PLANT.BODY.XOUT", 0.88, {"PLANT.HYST.XOUT"}},
          {"PLANT.Y", 0.72, {}},
          {"DRIVE.XOUT", 0.46, {"AMPLIFIER.XOUT", "U"}},
          {"AMPLIFIER.XOUT", 0.45, {"DRIVE.XOUT"}},
          {"SENSOR.XOUT", 0.31, {"Y"}},
          {"DRIVE.XIN", 0.22, {}},
          {"SUM.XOUT", 0.08, {}},
          {"LAST.XOUT", 0.06, {}},
          {"PLANT.EXPANSION.XOUT", 0.02, {}}};
}

std::vector<EffectFinding> effects() {
  return {{.id = "creep",
           .edge = "PLANT.HYST.XOUT",
           .same_edges = {"PLANT.BODY.XOUT"},
           .share = 0.68,
           .inverse = Inverse::Exact,
           .parameters = {{"GAIN", 0.02104, 0.0198, 0.0223, "1"}, {"T_ONSET", 0.1032, 0.0711, 0.1498, "s"}}},
          {.id = "backlash",
           .edge = "PLANT.Y",
           .share = 0.24,
           .inverse = Inverse::Avoidable,
           .parameters = {{"WIDTH", 0.0803, 0.0772, 0.0829, "um"}},
           .settings = {{"CENTRE", 12.5, "um"}}},
          {.id = "delay",
           .edge = "DRIVE.XOUT",
           .same_edges = {"AMPLIFIER.XOUT", "U"},
           .share = 0.08,
           .inverse = Inverse::None,
           .parameters = {{"DEAD_TIME", 0.0031, 0.0024, 0.0037, "s"}}}};
}

NextExperiment next() {
  NextExperiment next{.title = "staircase with dwells",
                      .reason =
                          "Creep goes on at every level; a drift of the sensor does not know the level. Each is "
                          "held for 30 s, and the same level is reached from both sides.",
                      .input = "REF",
                      .unit = "um",
                      .separation = 14.2};
  const double levels[] = {0.0, 10.0, 20.0, 30.0, 20.0, 10.0, 0.0};
  double t = 0.0;
  for (const double level : levels) {
    for (int k = 0; k < 300; ++k, t += 0.1) {
      next.time.push_back(t);
      next.values.push_back(level);
    }
    next.steps.emplace_back("REF to " + std::to_string(static_cast<int>(level)) + " um at 200 um/s, then hold", "30 s");
  }
  return next;
}

}  // namespace

Program rich_program() {
  return compile_text(diagram, {.top = "PIEZO_AXIS", .any_order = true, .keep_names = true});
}

Diagnosis rich_diagnosis(std::size_t samples) {
  Diagnosis found;
  found.verdict = Verdict::Named;
  found.summary =
      "Creep of the stage explains two thirds of the gap of Y, lost motion behind it a quarter and a dead time of the "
      "drive the rest; together they close 97 %.";
  found.warnings = {"The record Y is clipped at 31.5 um for 0.4 s; those samples do not count.",
                    "No input is repeated: the floor is from dwells."};
  found.effects = effects();
  found.calibration = {{"PLANT.HYST.C1", 0.2043, 0.2031, 0.2055, "um/V"},
                       {"PLANT.HYST.C2", 0.0104, 0.0099, 0.0109, "um/V^2"}};
  found.nominal = {{"PLANT.HYST.C1", 0.2, 0.19, 0.21, "um/V"}, {"PLANT.HYST.C2", 0.01, 0.009, 0.011, "um/V^2"}};
  found.rivals = {
      {{"creep", "backlash", "delay"}, {"PLANT.HYST.XOUT", "PLANT.Y", "DRIVE.XOUT"}, 6, 0.0192, 0.0, 0.86},
      {{"creep", "backlash", "lag"}, {"PLANT.HYST.XOUT", "PLANT.Y", "DRIVE.XOUT"}, 6, 0.0194, -2.3, 0.09},
      {{"thermal_drift", "backlash", "delay"}, {"SENSOR.XOUT", "PLANT.Y", "DRIVE.XOUT"}, 6, 0.0201, -3.1, 0.04},
      {{"relaxation", "coulomb_friction", "delay"}, {"PLANT.HYST.XOUT", "PLANT.BODY.XIN", "U"}, 7, 0.0215, -4.4, 0.01}};
  found.confidence = 0.86;
  found.unknown_score = 0.02;
  found.gap = {.signal = "Y",
               .unit = "um",
               .nominal = 1.83,
               .calibrated = 0.842,
               .improved = 0.0192,
               .floor = {.differences = 0.011, .dwells = 0.0161, .repeats = 0.0, .value = 0.0161, .evidence = "dwells"},
               .closed = 0.9712,
               .closed_low = 0.952,
               .closed_high = 0.984};
  found.gaps = {
      found.gap,
      {.signal = "U",
       .unit = "V",
       .nominal = 12.1,
       .calibrated = 4.4,
       .improved = 0.31,
       .floor = {.differences = 0.28, .dwells = 0.0, .repeats = 0.0, .value = 0.28, .evidence = "differences"},
       .closed = 0.994,
       .closed_low = 0.98,
       .closed_high = 0.999}};
  found.edges = edges();
  found.maps = {
      map_of("amplitude", "um", 0.5, 31.0, false, 0.34),    map_of("rate", "um/s", 0.1, 3000.0, true, 0.12),
      map_of("branch depth", "um", 0.0, 62.0, false, 0.21), map_of("time since branch", "s", 0.002, 40.0, true, 0.61),
      map_of("direction", "", -1.0, 1.0, false, 0.18),      map_of("frequency", "Hz", 0.1, 450.0, true, 0.05),
      map_of("run time", "s", 0.0, 300.0, false, 0.07),     map_of("temperature", "K", 293.1, 295.6, false, 0.004)};
  found.cannot_tell = {
      "creep on PLANT.HYST.XOUT and on PLANT.BODY.XOUT: the body is linear and both are time-invariant, so their order "
      "does not show in the input and the output",
      "a delay before and after the amplifier: a gain lets every delay pass"};
  found.next = next();
  found.traces = {trace_of("run 3, triangles", "Y", "um", samples, 30.0),
                  trace_of("run 3, triangles", "U", "V", samples, 100.0),
                  trace_of("run 4, steps", "Y", "um", samples / 2, 12.0)};
  found.improved_text = diagram;
  found.tried = 412;
  found.seconds = 8.73;
  return found;
}

Diagnosis refused_diagnosis() {
  Diagnosis found;
  found.summary = "The record cannot be diagnosed.";
  found.refusals = {"U is constant over the whole record: nothing was excited.", "Y has 12 samples, too few."};
  return found;
}

}  // namespace hysteron::diagnosis::fixture
