// Within the runtime, `test::` finds the helpers of its own tests and those of all rooms.
#pragma once

namespace hysteron::test {}
namespace hysteron::runtime::test {
using namespace hysteron::test;
}
