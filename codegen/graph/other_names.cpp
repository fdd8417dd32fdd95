#include "codegen/graph/other_names.hpp"

#include <array>
#include <cctype>

namespace hysteron {
namespace {

constexpr std::array known_names{
    OtherName{"TON", "IEC 61131-3", "HY_TON", "times are LREAL in seconds"},
    OtherName{"TOF", "IEC 61131-3", "HY_TOF", "times are LREAL in seconds"},
    OtherName{"TP", "IEC 61131-3", "HY_TP", "times are LREAL in seconds"},
    OtherName{"CTU", "IEC 61131-3", "HY_CTU", ""},
    OtherName{"CTD", "IEC 61131-3", "HY_CTD", ""},
    OtherName{"CTUD", "IEC 61131-3", "HY_CTUD", ""},
    OtherName{"R_TRIG", "IEC 61131-3", "HY_R_TRIG", ""},
    OtherName{"F_TRIG", "IEC 61131-3", "HY_F_TRIG", ""},
    OtherName{"SR", "IEC 61131-3", "HY_SR", ""},
    OtherName{"RS", "IEC 61131-3", "HY_RS", ""},
    OtherName{"ADD", "IEC 61131-3", "HY_SUM", "the operator + does the same"},
    OtherName{"SUB", "IEC 61131-3", "HY_SUBTRACT", "the operator - does the same"},
    OtherName{"MUL", "IEC 61131-3", "HY_PRODUCT", "the operator * does the same"},
    OtherName{"DIV", "IEC 61131-3", "HY_QUOTIENT", "a divisor of 0 gives 0 and ERROR"},
    OtherName{"EXPT", "IEC 61131-3", "HY_POWER", "the function EXPT does the same"},
    OtherName{"SEL", "IEC 61131-3", "HY_SWITCH", "the function SEL does the same"},
    OtherName{"LIMIT", "IEC 61131-3", "HY_LIMIT", "the function LIMIT does the same"},
    OtherName{"DERIVATIVE", "IEC 61131-3", "HY_DERIVATIVE",
              "two points; HY_DERIVATIVE4 takes four, as the standard's example"},
    OtherName{"INTEGRAL", "IEC 61131-3", "HY_INTEGRAL", ""},
    OtherName{"PID", "IEC 61131-3", "HY_PID", "bounds of the output and anti-windup are inside"},
    OtherName{"RAMP", "IEC 61131-3", "HY_RAMP", ""},
    OtherName{"HYSTERESIS", "IEC 61131-3", "HY_HYSTERESIS", ""},
    OtherName{"DELAY", "IEC 61131-3", "HY_DEAD_TIME", "HY_DELAY is one sample"},
    OtherName{"CTRL_PI", "OSCAT", "HY_PID", "with TD := 0.0"},
    OtherName{"CTRL_PID", "OSCAT", "HY_PID", ""},
    OtherName{"FT_PI", "OSCAT", "HY_PID", "with TD := 0.0"},
    OtherName{"FT_PID", "OSCAT", "HY_PID", ""},
    OtherName{"FT_PIDW", "OSCAT", "HY_PID", "anti-windup is always on"},
    OtherName{"FT_PT1", "OSCAT", "HY_LAG", "the gain is a HY_GAIN of its own"},
    OtherName{"FT_PT2", "OSCAT", "HY_SECOND_ORDER", ""},
    OtherName{"FT_PDT1", "OSCAT", "HY_LEAD_LAG", ""},
    OtherName{"FT_DERIV", "OSCAT", "HY_DERIVATIVE", ""},
    OtherName{"FT_INT", "OSCAT", "HY_INTEGRAL_BOUNDED", ""},
    OtherName{"FT_TN8", "OSCAT", "HY_DEAD_TIME", ""},
    OtherName{"FT_TN16", "OSCAT", "HY_DEAD_TIME", ""},
    OtherName{"FT_TN64", "OSCAT", "HY_DEAD_TIME", ""},
    OtherName{"DEAD_BAND", "OSCAT", "HY_DEAD_BAND", "WIDTH is the whole band"},
    OtherName{"HYST", "OSCAT", "HY_HYSTERESIS", "two inputs are compared with a band, in place of two thresholds"},
    OtherName{"SH", "OSCAT", "HY_SAMPLE_AND_HOLD", "a HY_R_TRIG before TRACK takes single samples"},
    OtherName{"GEN_SIN", "OSCAT", "HY_SINE", ""},
    OtherName{"GEN_SQ", "OSCAT", "HY_BLINK", ""},
    OtherName{"BLINK", "CODESYS Util", "HY_BLINK", "times are LREAL in seconds"},
    OtherName{"CHARCURVE", "CODESYS Util", "HY_TABLE", "points are LREAL"},
    OtherName{"HYSTERESIS", "CODESYS Util", "HY_HYSTERESIS",
              "two inputs are compared with a band, in place of two thresholds"},
    OtherName{"RAMP_REAL", "CODESYS Util", "HY_RATE_LIMIT", ""},
    OtherName{"PD", "CODESYS Util", "HY_PID", "with TR unset, the integral part is off"},
    OtherName{"Unit Delay", "Simulink", "HY_DELAY", ""},
    OtherName{"Memory", "Simulink", "HY_DELAY", ""},
    OtherName{"Gain", "Simulink", "HY_GAIN", ""},
    OtherName{"Sum", "Simulink", "HY_SUM", ""},
    OtherName{"Add", "Simulink", "HY_SUM", ""},
    OtherName{"Subtract", "Simulink", "HY_SUBTRACT", ""},
    OtherName{"Product", "Simulink", "HY_PRODUCT", ""},
    OtherName{"Divide", "Simulink", "HY_QUOTIENT", "a divisor of 0 gives 0 and ERROR"},
    OtherName{"Saturation", "Simulink", "HY_LIMIT", ""},
    OtherName{"Dead Zone", "Simulink", "HY_DEAD_BAND", "symmetric, WIDTH is the whole band"},
    OtherName{"Rate Limiter", "Simulink", "HY_RATE_LIMIT", ""},
    OtherName{"Relay", "Simulink", "HY_HYSTERESIS", "a truth value; HY_SWITCH makes two levels of it"},
    OtherName{"Backlash", "Simulink", "HY_BACKLASH", ""},
    OtherName{"Quantizer", "Simulink", "HY_QUANTIZER", ""},
    OtherName{"1-D Lookup Table", "Simulink", "HY_TABLE", ""},
    OtherName{"Discrete-Time Integrator", "Simulink", "HY_INTEGRAL_FORWARD",
              "forward Euler, Simulink's default; HY_INTEGRAL takes the step's own input"},
    OtherName{"Discrete Derivative", "Simulink", "HY_DERIVATIVE", ""},
    OtherName{"Transport Delay", "Simulink", "HY_DEAD_TIME", ""},
    OtherName{"Transfer Fcn First Order", "Simulink", "HY_LAG", ""},
    OtherName{"Transfer Fcn Lead or Lag", "Simulink", "HY_LEAD_LAG", ""},
    OtherName{"PID Controller", "Simulink", "HY_PID", ""},
    OtherName{"Switch", "Simulink", "HY_SWITCH", "G is a truth value, not a threshold"},
    OtherName{"Rate Transition", "Simulink", "HY_SAMPLE", "into the slower part; HY_HOLD into the faster one"},
    OtherName{"Zero-Order Hold", "Simulink", "HY_SAMPLE", ""},
    OtherName{"Step", "Simulink", "HY_STEP", ""},
    OtherName{"Sine Wave", "Simulink", "HY_SINE", ""},
    OtherName{"Pulse Generator", "Simulink", "HY_BLINK", ""},
    OtherName{"Coulomb and Viscous Friction", "Simulink", "HY_COULOMB_FRICTION",
              "the viscous part is HY_VISCOUS_FRICTION"},
    OtherName{"Detect Rise Positive", "Simulink", "HY_R_TRIG", "of a truth value"},
    OtherName{"Detect Fall Negative", "Simulink", "HY_F_TRIG", "of a truth value"},
    OtherName{"Compare To Constant", "Simulink", "HY_GT", "or another comparison"},
    OtherName{"Abs", "Simulink", "HY_ABS", ""},
    OtherName{"Sign", "Simulink", "HY_SIGN", ""},
    OtherName{"Constant", "Simulink", "HY_CONSTANT", ""},
};

/// Letters and digits alone, in capitals, without a prefix HY_: UnitDelay, unit_delay and Unit Delay are one name.
std::string letters_of(std::string_view name) {
  std::string result;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      result += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
  }
  return result.starts_with("HY") && name.find('_') == 2 ? result.substr(2) : result;
}

}  // namespace

std::span<const OtherName> other_names() {
  return known_names;
}

std::string_view block_of_other_name(std::string_view name) {
  for (const OtherName& one : known_names) {
    if (letters_of(one.name) == letters_of(name)) {
      return one.block;
    }
  }
  return {};
}

}  // namespace hysteron
