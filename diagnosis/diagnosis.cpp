#include "diagnosis/diagnosis.hpp"

namespace hysteron::diagnosis {

std::string_view name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::None:
      return "none";
    case Verdict::Calibration:
      return "calibration";
    case Verdict::Named:
      return "named";
    case Verdict::Group:
      return "group";
    case Verdict::Partial:
      return "partial";
    case Verdict::Unknown:
      return "unknown";
  }
  return "unknown";
}

}  // namespace hysteron::diagnosis
