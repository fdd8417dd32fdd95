// How a batch spells operations: those of C++ on vectors, functions of `lanes` where vectors have none.
#pragma once

#include "codegen/backends/c_family/printer.hpp"

namespace hysteron {

extern const DialectOfC batch_dialect;

}  // namespace hysteron
