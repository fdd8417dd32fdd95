#include "diagnosis/report/verdict_json.hpp"

#include <nlohmann/json.hpp>

#include "support/json_number.hpp"
namespace hysteron::diagnosis {
namespace {

using Json = nlohmann::ordered_json;

Json parameters_of(const std::vector<ParameterFinding>& list) {
  Json result = Json::object();
  for (const ParameterFinding& one : list) {
    result[one.name] = {{"value", number_or_null<Json>(one.value)},
                        {"low", number_or_null<Json>(one.low)},
                        {"high", number_or_null<Json>(one.high)},
                        {"unit", one.unit}};
  }
  return result;
}

Json settings_of(const std::vector<SettingFinding>& list) {
  Json result = Json::object();
  for (const SettingFinding& one : list) {
    result[one.name] = {{"value", number_or_null<Json>(one.value)}, {"unit", one.unit}};
  }
  return result;
}

Json sets_of(const std::vector<Rival>& list) {
  Json result = Json::array();
  for (const Rival& one : list) {
    result.push_back({{"effects", one.effects},
                      {"edges", one.edges},
                      {"parameters", one.parameters},
                      {"improved_rms", number_or_null<Json>(one.improved_rms)},
                      {"support", number_or_null<Json>(one.support)},
                      {"probability", number_or_null<Json>(one.probability)}});
  }
  return result;
}

Json families_of(const Evidence& evidence) {
  Json result = Json::array();
  for (const FamilyFinding& one : evidence.families) {
    result.push_back({{"family", one.family},
                      {"probability", number_or_null<Json>(one.probability)},
                      {"probability_by_record", number_or_null<Json>(one.by_record)},
                      {"closed", number_or_null<Json>(one.closed)},
                      {"closed_alone", number_or_null<Json>(one.alone)},
                      {"effect", one.effect},
                      {"effect_probability", number_or_null<Json>(one.member)},
                      {"edge", one.edge}});
  }
  return result;
}

Json law_sets_of(const Evidence& evidence) {
  Json result = Json::array();
  for (const SetFinding& set : evidence.sets) {
    Json laws = Json::array();
    for (const LawFinding& law : set.laws) {
      Json values = Json::object();
      for (const LawValue& value : law.values) {
        values[value.name] = {{"value", number_or_null<Json>(value.value)},
                              {"error", number_or_null<Json>(value.error)}};
      }
      laws.push_back({{"effect", law.effect},
                      {"family", law.family},
                      {"edge", law.edge},
                      {"drivers", law.drivers},
                      {"closed", number_or_null<Json>(law.closed)},
                      {"values", std::move(values)}});
    }
    result.push_back({{"probability", number_or_null<Json>(set.probability)},
                      {"closed", number_or_null<Json>(set.closed)},
                      {"compared_at", set.space},
                      {"effects", std::move(laws)}});
  }
  return result;
}

Json budget_of(const std::optional<GapBudget>& budget) {
  if (!budget) {
    return nullptr;
  }
  Json kinds = Json::array();
  for (const KindFinding& one : budget->kinds) {
    kinds.push_back({{"kind", one.kind},
                     {"share", number_or_null<Json>(one.share)},
                     {"alone", number_or_null<Json>(one.alone)},
                     {"alone_low", number_or_null<Json>(one.low)},
                     {"alone_high", number_or_null<Json>(one.high)},
                     {"only", number_or_null<Json>(one.only)}});
  }
  return {{"at", budget->at},
          {"closed", number_or_null<Json>(budget->closed)},
          {"noise", number_or_null<Json>(budget->noise)},
          {"kinds", std::move(kinds)}};
}

Json loop_of(const std::optional<LoopFinding>& loop) {
  if (!loop) {
    return nullptr;
  }
  return {{"input", loop->input},
          {"output", loop->output},
          {"feedback", number_or_null<Json>(loop->feedback)},
          {"oddness", number_or_null<Json>(loop->oddness)}};
}

Json gap_of(const GapFinding& gap) {
  return {{"signal", gap.signal},
          {"unit", gap.unit},
          {"nominal_rms", number_or_null<Json>(gap.nominal)},
          {"calibrated_rms", number_or_null<Json>(gap.calibrated)},
          {"improved_rms", number_or_null<Json>(gap.improved)},
          {"floor_rms", number_or_null<Json>(gap.floor.value)},
          {"closed", number_or_null<Json>(gap.closed)},
          {"closed_low", number_or_null<Json>(gap.closed_low)},
          {"closed_high", number_or_null<Json>(gap.closed_high)},
          {"floor_evidence", gap.floor.evidence}};
}

/// What each output's RMS will be on a further record, whose inputs stay where those of this one were.
Json prediction_of(const Diagnosis& found) {
  Json inputs = Json::array();
  for (const InputRange& input : found.inputs) {
    inputs.push_back({{"signal", input.signal},
                      {"unit", input.unit},
                      {"low", number_or_null<Json>(input.low)},
                      {"high", number_or_null<Json>(input.high)}});
  }
  Json list = Json::array();
  for (const GapFinding& gap : found.gaps) {
    if (gap.next) {
      list.push_back({{"signal", gap.signal},
                      {"unit", gap.unit},
                      {"rms", number_or_null<Json>(gap.next->rms)},
                      {"low", number_or_null<Json>(gap.next->low)},
                      {"high", number_or_null<Json>(gap.next->high)},
                      {"inputs", inputs}});
    }
  }
  return list;
}

Json where_of(const Diagnosis& found) {
  Json edges = Json::array();
  for (const EdgeFinding& edge : found.edges) {
    edges.push_back({{"edge", edge.edge}, {"share", number_or_null<Json>(edge.share)}, {"group", edge.group}});
  }
  Json cuts = Json::array();
  for (const CutFinding& cut : found.cuts) {
    cuts.push_back({{"signal", cut.signal}, {"agrees", cut.agrees}});
  }
  Json regions = Json::array();
  Json bands = Json::array();
  Json times = Json::array();
  for (const MapFinding& map : found.maps) {
    Json one = {{"over", map.over},     {"unit", map.unit},     {"share", number_or_null<Json>(map.share)},
                {"places", map.places}, {"before", map.before}, {"after", map.after}};
    (map.over == "frequency" ? bands : map.over == "run time" ? times : regions).push_back(std::move(one));
  }
  return {{"edges", std::move(edges)},
          {"cuts", std::move(cuts)},
          {"regions", std::move(regions)},
          {"bands", std::move(bands)},
          {"times", std::move(times)}};
}

Json split_of(const Diagnosis& found) {
  Json result = {{"input_output", number_or_null<Json>(found.split.input_output)},
                 {"plant", number_or_null<Json>(found.split.plant)},
                 {"open", number_or_null<Json>(found.split.open)}};
  if (found.controller) {
    Json outputs = Json::object();
    for (const ControllerFinding::Output& output : found.controller->outputs) {
      outputs[output.name] = {{"unit", output.unit},
                              {"difference_rms", number_or_null<Json>(output.difference_rms)},
                              {"limited_rms", number_or_null<Json>(output.limited_rms)}};
    }
    result["controller"] = {
        {"same_bits", found.controller->different == 0}, {"steps", found.controller->steps},
        {"different", found.controller->different},      {"first_different", found.controller->first_different},
        {"dropped", found.controller->dropped},          {"outputs", std::move(outputs)}};
  }
  return result;
}

}  // namespace

std::string verdict_json(const Diagnosis& found) {
  Json effects = Json::array();
  for (const EffectFinding& effect : found.effects) {
    effects.push_back({{"id", effect.id},
                       {"family", effect.family},
                       {"edge", effect.edge},
                       {"same_edges", effect.same_edges},
                       {"drivers", effect.drivers},
                       {"share", number_or_null<Json>(effect.share)},
                       {"around_plant", effect.around_plant},
                       {"invertible", effect.inverse == Inverse::Exact},
                       {"parameters", parameters_of(effect.parameters)},
                       {"settings", settings_of(effect.settings)}});
  }
  Json rivals = Json::array();
  for (const Rival& rival : found.rivals) {
    rivals.push_back(rival.effects);
  }
  Json next = Json::object();
  if (!found.next.title.empty()) {
    Json steps = Json::array();
    for (const auto& [what, how] : found.next.steps) {
      steps.push_back({{"what", what}, {"how", how}});
    }
    next = {{"title", found.next.title},
            {"reason", found.next.reason},
            {"input", found.next.input},
            {"unit", found.next.unit},
            {"separation", number_or_null<Json>(found.next.separation)},
            {"steps", std::move(steps)}};
  } else if (!found.next.reason.empty()) {
    next = {{"reason", found.next.reason}};
  }
  Json gaps = Json::array();
  for (const GapFinding& gap : found.gaps) {
    gaps.push_back(gap_of(gap));
  }
  Json decisions = Json::array();
  for (const Decision& one : found.decisions) {
    decisions.push_back({{"rule", one.rule},
                         {"about", one.about},
                         {"measured", number_or_null<Json>(one.measured)},
                         {"threshold", number_or_null<Json>(one.threshold)},
                         {"unit", one.unit},
                         {"outcome", one.outcome}});
  }
  Json verdict = {{"schema", "hysteron-verdict/1"},
                  {"verdict", name_of(found.verdict)},
                  {"effects", std::move(effects)},
                  {"rivals", std::move(rivals)},
                  {"confidence", number_or_null<Json>(found.confidence)},
                  {"siblings", found.siblings},
                  {"families", families_of(found.evidence)},
                  {"evidence", law_sets_of(found.evidence)},
                  {"budget", budget_of(found.budget)},
                  {"control_loop", loop_of(found.loop)},
                  {"unknown_score", number_or_null<Json>(found.unknown_score)},
                  {"gap", gap_of(found.gap)},
                  {"prediction", prediction_of(found)},
                  {"where", where_of(found)},
                  {"split", split_of(found)},
                  {"cannot_tell", found.cannot_tell},
                  {"next_experiment", std::move(next)},
                  {"work", found.work},
                  {"seconds", number_or_null<Json>(found.seconds)},
                  {"summary", found.summary},
                  {"refused", !found.refusals.empty()},
                  {"refusals", found.refusals},
                  {"warnings", found.warnings},
                  {"calibration", parameters_of(found.calibration)},
                  {"nominal", parameters_of(found.nominal)},
                  {"rival_details", sets_of(found.rivals)},
                  {"fitted", sets_of(found.fitted)},
                  {"gaps", std::move(gaps)},
                  {"tracking",
                   {{"nominal_rms", number_or_null<Json>(found.tracking_nominal)},
                    {"improved_rms", number_or_null<Json>(found.tracking_improved)},
                    {"notes", found.feedforward_notes}}},
                  {"candidates_tried", found.tried}};
  if (!found.decisions.empty()) {
    verdict["decisions"] = std::move(decisions);
  }
  return verdict.dump(2) + "\n";
}

}  // namespace hysteron::diagnosis
