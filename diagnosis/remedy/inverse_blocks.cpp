#include "diagnosis/remedy/inverse_blocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "blocks/creep.hpp"
#include "codegen/graph/names.hpp"
#include "support/numbers.hpp"

namespace hysteron::diagnosis {
namespace {

/// A literal that can stand behind an operator.
std::string number(double value) {
  if (!std::isfinite(value)) {
    throw NoInverse("a parameter is not finite");
  }
  return value < 0.0 ? "(" + real_literal(value) + ")" : real_literal(value);
}

/// XOUT = XIN + what does not depend on XIN.
std::string take_off(InverseText& text, const BlockStage& stage) {
  const std::string copy = text.instance(stage.name, stage.node.block->about.name, stage.settings());
  text.call(copy, stage.arguments("0.0"));
  return fmt::format("{} - {}.XOUT", stage.wanted, copy);
}

std::string gain_drift(InverseText& text, const BlockStage& stage) {
  const std::string copy = text.instance(stage.name, stage.node.block->about.name, stage.settings());
  text.call(copy, stage.arguments("1.0"));
  return fmt::format("{} / {}.XOUT", stage.wanted, copy);
}

std::string offset(InverseText& /*text*/, const BlockStage& stage) {
  return fmt::format("{} - {}", stage.wanted, number(stage.value("BIAS")));
}

std::string gain(InverseText& text, const BlockStage& stage) {
  const double k = stage.value("K");
  if (k == 0.0) {
    throw NoInverse(fmt::format("{} has the gain 0", stage.node.path));
  }
  const std::string inverse = text.instance(stage.name, "HY_GAIN", "K := " + real_literal(1.0 / k));
  text.call(inverse, "XIN := " + stage.wanted);
  return inverse + ".XOUT";
}

std::string as_it_is(InverseText& text, const BlockStage& stage) {
  text.note(fmt::format("{} ({}) is left as it is", stage.node.path, stage.node.block->about.name));
  return stage.wanted;
}

std::string limited(InverseText& text, const BlockStage& stage) {
  text.note(fmt::format("{} ({}) is left as it is: the reference must be planned within its limits", stage.node.path,
                        stage.node.block->about.name));
  return stage.wanted;
}

std::string late(InverseText& text, const BlockStage& stage) {
  const bool one = stage.node.block->about.name == "HY_DELAY";
  const double seconds = one ? text.sample_time() : stage.value("DEAD_TIME");
  text.look_ahead(seconds);
  if (seconds > 0.0) {
    text.note(
        fmt::format("{} has to come {} s early, for {}", text.reference(), number_text(seconds), stage.node.path));
  }
  return stage.wanted;
}

/// A static nonlinearity over z = (x − centre)/reference, dimensionless: wanted z in, z out, x back.
struct Normalised {
  std::string wanted{};
  std::string scale{};  ///< an instance of HY_GAIN that leads back
  double centre = 0.0;
};

Normalised normalised(InverseText& text, const BlockStage& stage, double centre, double reference) {
  const std::string down = text.instance(stage.name + "_NORM", "HY_GAIN", "K := " + real_literal(1.0 / reference));
  text.call(down, fmt::format("XIN := {}{}", stage.wanted, centre == 0.0 ? "" : " - " + number(centre)));
  return {.wanted = text.signal(stage.name + "_W", down + ".XOUT", "1"),
          .scale = text.instance(stage.name + "_BACK", "HY_GAIN", "K := " + real_literal(reference)),
          .centre = centre};
}

std::string scaled_back(InverseText& text, const Normalised& from, const std::string& z) {
  text.call(from.scale, "XIN := " + z);
  return from.centre == 0.0 ? from.scale + ".XOUT" : fmt::format("{}.XOUT + {}", from.scale, number(from.centre));
}

/// z + s·z² = w: the root that is w where s is 0. Beyond the turning point the point itself.
std::string even(InverseText& text, const BlockStage& stage) {
  const double reference = stage.value("REFERENCE");
  const Normalised z = normalised(text, stage, stage.value("CENTRE"), reference);
  const double s = stage.value("SIZE") / reference;
  const std::string root =
      text.signal(stage.name + "_ROOT", fmt::format("SQRT(MAX(1.0 + {} * {}, 0.0))", number(4.0 * s), z.wanted), "1");
  return scaled_back(text, z, fmt::format("2.0 * {} / (1.0 + {})", z.wanted, root));
}

/// z + s·z³ = w by Newton steps. Where s < 0, z stays below the turning point.
std::string odd(InverseText& text, const BlockStage& stage) {
  const double reference = stage.value("REFERENCE");
  Normalised z = normalised(text, stage, stage.value("CENTRE"), reference);
  const double s = stage.value("SIZE") / reference;
  if (s < 0.0) {
    const double turn = 1.0 / std::sqrt(-3.0 * s);
    const double most = 0.999 * turn * (2.0 / 3.0);
    z.wanted = text.signal(stage.name + "_IN",
                           fmt::format("LIMIT({}, {}, {})", real_literal(-most), z.wanted, real_literal(most)), "1");
  }
  std::string at = z.wanted;
  constexpr int steps = 7;
  for (int step = 0; step < steps; ++step) {
    at = text.signal(stage.name + "_Z",
                     fmt::format("({2} + {0} * {1} * {1} * {1}) / (1.0 + {3} * {1} * {1})", number(2.0 * s), at,
                                 z.wanted, number(3.0 * s)),
                     "1");
  }
  return scaled_back(text, z, at);
}

/// z + a·sin(2πz) + b·cos(2πz) = w by Newton steps.
std::string periodic(InverseText& text, const BlockStage& stage) {
  const double pitch = stage.value("PITCH");
  const double a = stage.value("SINE") / pitch;
  const double b = stage.value("COSINE") / pitch;
  const double two_pi = 2.0 * std::numbers::pi;
  if (two_pi * std::hypot(a, b) >= 0.9) {
    throw NoInverse(fmt::format("{} hardly rises between its ripples", stage.node.path));
  }
  const Normalised z = normalised(text, stage, 0.0, pitch);
  std::string at = z.wanted;
  for (int step = 0; step < 6; ++step) {
    const std::string angle = text.signal(stage.name + "_ANGLE", fmt::format("{} * {}", number(two_pi), at), "1");
    at = text.signal(
        stage.name + "_Z",
        fmt::format("{0} - ({0} + {1} * SIN({2}) + {3} * COS({2}) - {4}) / (1.0 + {5} * COS({2}) - {6} * SIN({2}))", at,
                    number(a), angle, number(b), z.wanted, number(two_pi * a), number(two_pi * b)),
        "1");
  }
  return scaled_back(text, z, at);
}

/// A number times a rate, in the unit of what it is added to.
std::string times(InverseText& text, const BlockStage& stage, std::string_view what, double factor,
                  const std::string& of) {
  const std::string product =
      text.instance(fmt::format("{}_{}", stage.name, what), "HY_GAIN", "K := " + real_literal(factor));
  text.call(product, "XIN := " + of);
  return product + ".XOUT";
}

void note_smooth(InverseText& text, const BlockStage& stage) {
  text.note(fmt::format("{} is inverted for a smooth {}, with an error that falls with the square of the sample time",
                        stage.node.path, text.reference()));
}

std::string lag(InverseText& text, const BlockStage& stage) {
  const double t1 = stage.value("T1");
  if (t1 == 0.0) {
    return stage.wanted;
  }
  note_smooth(text, stage);
  const std::string rate = text.rate(stage.name, stage.wanted, 0.5);
  return fmt::format("{} + {}", stage.wanted, times(text, stage, "T1", t1, rate));
}

std::string second_order(InverseText& text, const BlockStage& stage) {
  const double t = stage.value("T");
  const double k = stage.value("K");
  if (k == 0.0) {
    throw NoInverse(fmt::format("{} has the gain 0", stage.node.path));
  }
  note_smooth(text, stage);
  const std::string rate = text.rate(stage.name, stage.wanted, 0.5);
  const std::string acceleration = text.rate(stage.name + "_RATE", rate, 0.5);
  const std::string sum =
      fmt::format("{} + {} + {}", stage.wanted, times(text, stage, "DAMP", 2.0 * stage.value("ZETA") * t, rate),
                  times(text, stage, "MASS", t * t, acceleration));
  return times(text, stage, "STATIC", 1.0 / k, sum);
}

std::string lead_lag(InverseText& text, const BlockStage& stage) {
  if (stage.value("T1") == 0.0 && stage.value("T2") > 0.0) {
    note_smooth(text, stage);
    return fmt::format("{} + {}", stage.wanted,
                       times(text, stage, "T2", stage.value("T2"), text.rate(stage.name, stage.wanted, 0.5)));
  }
  note_smooth(text, stage);
  const std::string inverse = text.instance(
      stage.name, "HY_LEAD_LAG",
      fmt::format("T1 := {}, T2 := {}", real_literal(stage.value("T2")), real_literal(stage.value("T1"))));
  text.call(inverse, "XIN := " + stage.wanted);
  return inverse + ".XOUT";
}

std::string integral(InverseText& text, const BlockStage& stage) {
  text.note(fmt::format("{} must begin where {} starts", text.reference(), stage.node.path));
  return text.rate(stage.name, stage.wanted, 0.0);
}

std::string integral_forward(InverseText& text, const BlockStage& stage) {
  text.note(fmt::format("{} must begin where {} starts, at rest", text.reference(), stage.node.path));
  return text.rate(stage.name, stage.wanted, 1.0);
}

/// y = x + G·z, T·z' + z = x: z is y behind a lag of T/(1 + G), over 1 + G, so that x is y with a relaxation too.
std::string relaxation(InverseText& text, const BlockStage& stage) {
  const double g = stage.value("GAIN");
  if (g <= -1.0) {
    throw NoInverse(fmt::format("{} follows a step by nothing in the end", stage.node.path));
  }
  note_smooth(text, stage);
  const std::string back = text.instance(
      stage.name, "HY_RELAXATION",
      fmt::format("GAIN := {}, T1 := {}, SETTLED := {}, SINCE_START := {}", real_literal(-g / (1.0 + g)),
                  real_literal(stage.value("T1") / (1.0 + g)), literal_text(Type::Bool, stage.value("SETTLED")),
                  literal_text(Type::Bool, stage.value("SINCE_START"))));
  text.call(back, "XIN := " + stage.wanted);
  return back + ".XOUT";
}

/// What of a step HY_CREEP with GAIN = 1 has crept by the sample of the step itself: a ramp over one sample.
double crept_at_once(double onset, double sample_time) {
  double sum = 0.0;
  for (std::size_t i = 0; i < Creep::lags; ++i) {
    const double w = sample_time / (onset * Creep::times[i]);
    sum += Creep::weights[i] * (1.0 + std::expm1(-w) / w);
  }
  return sum;
}

/// x(k) = y(k) − crept(k), the crept part of x so far carried on straight over one sample.
std::string creep(InverseText& text, const BlockStage& stage) {
  const double g = stage.value("GAIN");
  const double all = std::accumulate(Creep::weights.begin(), Creep::weights.end(), 0.0);
  const double at_once = g * crept_at_once(stage.value("T_ONSET"), text.sample_time());
  if (std::abs(at_once) > 0.3) {
    throw NoInverse(fmt::format("{} creeps by {:.2g} of a step within one sample", stage.node.path, at_once));
  }
  note_smooth(text, stage);
  const std::string model = text.instance(stage.name, "HY_CREEP", stage.settings());
  const std::string one = text.instance(stage.name + "_PAST", "HY_DELAY");
  const std::string two = text.instance(stage.name + "_BEFORE", "HY_DELAY");
  const std::string from_second = text.started(1);
  const std::string from_third = text.started(2);
  const bool crept_before = stage.value("SETTLED") != 0.0 && stage.value("SINCE_START") == 0.0;
  const double settled = crept_before ? 1.0 / (1.0 + g * all) : 1.0;
  std::string x = text.signal(stage.name + "_X",
                              fmt::format("SEL({0}, {1} * {2}, {2} - {3}.XOUT - SEL({4}, 0.0, {3}.XOUT - {5}.XOUT))",
                                          from_second, number(settled), stage.wanted, one, from_third, two));
  text.call(model, "XIN := " + x);
  text.call(one, fmt::format("XIN := {}.XOUT - {}", model, x));
  text.call(two, fmt::format("XIN := {}.XOUT", one));
  return x;
}

std::string backlash(InverseText& text, const BlockStage& stage) {
  const std::string motion = text.instance(stage.name + "_MOTION", "HY_DERIVATIVE");
  const std::string held = text.instance(stage.name + "_HELD", "HY_DELAY");
  text.call(motion, "XIN := " + stage.wanted);
  const double half = 0.5 * stage.value("WIDTH");
  const double middle = half * stage.value("START");
  const std::string gap = text.signal(
      stage.name + "_GAP", fmt::format("SEL({0}.XOUT > 0.0, SEL({0}.XOUT < 0.0, {1}.XOUT, {2}), {3})", motion, held,
                                       real_literal(middle - half), real_literal(middle + half)));
  text.call(held, "XIN := " + gap);
  text.note(fmt::format("the input jumps by {} at each reversal, across the gap of {}", number_text(2.0 * half),
                        stage.node.path));
  if (stage.value("SPREAD") > 0.0) {
    text.note(fmt::format("the gap of {} is taken as one of its mean width", stage.node.path));
  }
  return fmt::format("{} + {}", stage.wanted, gap);
}

/// With soft edges the band's slope is 0, 1/3, 2/3 and 1 in turn, so that its inverse is the lowest of three lines.
std::string dead_band(InverseText& text, const BlockStage& stage) {
  const double half = 0.5 * stage.value("WIDTH");
  const double narrow = half * (1.0 - stage.value("SPREAD"));
  const std::string size = text.signal(stage.name + "_SIZE", fmt::format("ABS({})", stage.wanted));
  const std::string reached =
      narrow == half ? fmt::format("{} + {}", size, real_literal(half))
                     : fmt::format("MIN(MIN(3.0 * {0} + {1}, 1.5 * {0} + {2}), {0} + {3})", size, real_literal(narrow),
                                   real_literal(0.5 * (narrow + half)), real_literal(half));
  const std::string there = text.signal(stage.name + "_REACHED", reached);
  return fmt::format("SEL({0} > 0.0, SEL({0} < 0.0, 0.0, -{1}), {1})", stage.wanted, there);
}

std::string ro_settings(const BlockStage& stage) {
  const double band = stage.value("EPS") * stage.value("C1");
  return fmt::format("C1 := {}, C2 := {}, C3 := {}, EPS := {}, START := {}, U0 := {}, Y0 := {}",
                     real_literal(stage.value("C1")), real_literal(stage.value("C2")), real_literal(stage.value("C3")),
                     real_literal(band), literal_text(Type::Int, stage.value("START")), real_literal(stage.value("U0")),
                     real_literal(stage.value("Y0")));
}

std::string hysteresis(InverseText& text, const BlockStage& stage) {
  if (stage.value("EPS") > 0.0) {
    text.note(fmt::format("the dead band of {} is that of its steepness at a reversal", stage.node.path));
  }
  const std::string inverse = text.instance(stage.name, "HY_HYSTERESIS_RO_INVERSE", ro_settings(stage));
  text.call(inverse, "XIN := " + stage.wanted);
  return inverse + ".XOUT";
}

/// One Newton step a sample on a model that is driven by the result: x(k) = x(k−1) + (y(k) − model(k−1))/slope(k−1).
/// With return points the slope is at least that of the last step, since SLOPE is that of the last branching point.
std::string hysteresis_general(InverseText& text, const BlockStage& stage) {
  const BlockType& block = *stage.node.block;
  const BlockType& plain = *find_block_type(block.about.enriches);
  const bool is_plain = std::ranges::all_of(block.params, [&](const Field& one) {
    const bool is_extra =
        one.has_neutral() && std::ranges::find(plain.params, one.name, &Field::name) == plain.params.end();
    return !is_extra || stage.value(one.name) == one.neutral;
  });
  if (is_plain) {
    return hysteresis(text, stage);
  }
  note_smooth(text, stage);
  const std::string model = text.instance(stage.name + "_MODEL", stage.node.block->about.name, stage.settings());
  const std::string first = text.instance(stage.name + "_FIRST", "HY_HYSTERESIS_RO_INVERSE", ro_settings(stage));
  const std::string x1 = text.instance(stage.name + "_X1", "HY_DELAY");
  const std::string y1 = text.instance(stage.name + "_Y1", "HY_DELAY");
  const std::string m1 = text.instance(stage.name + "_M1", "HY_DELAY");
  const std::string later = text.started(1);
  text.call(first, "XIN := " + stage.wanted);
  const std::string slope = text.signal(
      stage.name + "_SLOPE", fmt::format("SEL({}, {}, {}.XOUT)", later, real_literal(stage.value("C1")), m1));
  std::string x = text.signal(stage.name + "_X", fmt::format("SEL({0}, {1}.XOUT, {2}.XOUT + ({3} - {4}.XOUT) / {5})",
                                                             later, first, x1, stage.wanted, y1, slope));
  text.call(model, "XIN := " + x);
  std::string tangent = model + ".SLOPE";
  if (stage.value("RETURN_POINT") != 0.0) {
    const std::string moved = text.signal(stage.name + "_DX", fmt::format("{} - {}.XOUT", x, x1));
    const std::string still = fmt::format("{} = 0.0", moved);
    tangent = fmt::format("MAX({0}, SEL({1} OR NOT ({2}), ({3}.XOUT - {4}.XOUT) / SEL({1}, {5}, 1.0), {0}))", tangent,
                          still, later, model, y1, moved);
  }
  text.call(x1, "XIN := " + x);
  text.call(y1, fmt::format("XIN := {}.XOUT", model));
  text.call(m1, fmt::format("XIN := {}", tangent));
  return x;
}

struct Rule {
  std::string_view block{};
  std::string (*inverse)(InverseText&, const BlockStage&) = nullptr;
};

constexpr std::array rules{
    Rule{"HY_GAIN", gain},
    Rule{"HY_OFFSET", offset},
    Rule{"HY_DRIFT", take_off},
    Rule{"HY_THERMAL_DRIFT", take_off},
    Rule{"HY_PERIODIC_DISTURBANCE", take_off},
    Rule{"HY_LOAD", take_off},
    Rule{"HY_CROSS_COUPLING", take_off},
    Rule{"HY_COULOMB_FRICTION", take_off},
    Rule{"HY_STRIBECK_FRICTION", take_off},
    Rule{"HY_DAHL_FRICTION", take_off},
    Rule{"HY_ASYMMETRIC_FRICTION", take_off},
    Rule{"HY_LOAD_FRICTION", take_off},
    Rule{"HY_VISCOUS_FRICTION", take_off},
    Rule{"HY_COGGING", take_off},
    Rule{"HY_CYCLIC_FORCE", take_off},
    Rule{"HY_GAIN_DRIFT", gain_drift},
    Rule{"HY_EVEN_NONLINEARITY", even},
    Rule{"HY_ODD_NONLINEARITY", odd},
    Rule{"HY_PERIODIC_ERROR", periodic},
    Rule{"HY_LAG", lag},
    Rule{"HY_LEAD_LAG", lead_lag},
    Rule{"HY_SECOND_ORDER", second_order},
    Rule{"HY_INTEGRAL", integral},
    Rule{"HY_INTEGRAL_BOUNDED", integral},  // a reference within the bounds does not meet them
    Rule{"HY_INTEGRAL_FORWARD", integral_forward},
    Rule{"HY_INTEGRAL_FORWARD_BOUNDED", integral_forward},
    Rule{"HY_RELAXATION", relaxation},
    Rule{"HY_CREEP", creep},
    Rule{"HY_BACKLASH", backlash},
    Rule{"HY_DEAD_BAND", dead_band},
    Rule{"HY_HYSTERESIS_RO", hysteresis},
    Rule{"HY_HYSTERESIS_GENERAL", hysteresis_general},
    Rule{"HY_DEAD_TIME", late},
    Rule{"HY_DELAY", late},
    Rule{"HY_LIMIT", limited},
    Rule{"HY_RATE_LIMIT", limited},
    Rule{"HY_QUANTIZER", as_it_is},
    Rule{"HY_CLOCK", as_it_is},
};

}  // namespace

bool adds_to_input(std::string_view block) {
  const auto* const rule = std::ranges::find(rules, block, &Rule::block);
  return rule != rules.end() && rule->inverse == take_off;
}

std::string inverse_of_block(InverseText& text, const BlockStage& stage) {
  const auto* const rule = std::ranges::find(rules, stage.node.block->about.name, &Rule::block);
  if (rule == rules.end()) {
    throw NoInverse(
        fmt::format("{} is a {}, which has no inverse here", stage.node.path, stage.node.block->about.name));
  }
  return rule->inverse(text, stage);
}

}  // namespace hysteron::diagnosis
