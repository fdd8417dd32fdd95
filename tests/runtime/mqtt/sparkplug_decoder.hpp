// Payloads of Sparkplug B to text and back, by protoc. The message is that of the specification, as far as it is used.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "tests/runtime/namespaces.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::runtime::test {

inline constexpr const char* sparkplug_message = R"(syntax = "proto2";
message Payload {
  message PropertyValue {
    optional uint32 type = 1;
    optional bool is_null = 2;
    oneof value {
      uint32 int_value = 3;
      uint64 long_value = 4;
      float float_value = 5;
      double double_value = 6;
      bool boolean_value = 7;
      string string_value = 8;
    }
  }
  message PropertySet {
    repeated string keys = 1;
    repeated PropertyValue values = 2;
  }
  message Metric {
    optional string name = 1;
    optional uint64 alias = 2;
    optional uint64 timestamp = 3;
    optional uint32 datatype = 4;
    optional bool is_historical = 5;
    optional bool is_transient = 6;
    optional bool is_null = 7;
    optional PropertySet properties = 9;
    oneof value {
      uint32 int_value = 10;
      uint64 long_value = 11;
      float float_value = 12;
      double double_value = 13;
      bool boolean_value = 14;
      string string_value = 15;
    }
  }
  optional uint64 timestamp = 1;
  repeated Metric metrics = 2;
  optional uint64 seq = 3;
  optional string uuid = 4;
  optional bytes body = 5;
}
)";

inline bool has_protoc() {
  return std::system("protoc --version > /dev/null 2>&1") == 0;
}

/// Of a test, from its SetUp.
inline void skip_without_protoc() {
  if (!has_protoc()) {
    GTEST_SKIP() << "protoc is not installed: scripts/install-dependencies test";
  }
}

/// What protoc makes of some bytes: "ERROR" where it refuses them.
inline std::string through_protoc(const std::string& how, const std::string& bytes) {
  const ScratchFolder folder;
  folder.write("sparkplug.proto", sparkplug_message);
  folder.write("in", bytes);
  const std::string command =
      "cd '" + folder.path().string() + "' && protoc --" + how + "=Payload sparkplug.proto < in > out 2> errors";
  if (std::system(command.c_str()) != 0) {
    return "ERROR " + contents_of(folder / "errors");
  }
  return contents_of(folder / "out");
}

inline std::string decoded_sparkplug(const std::string& bytes) {
  return through_protoc("decode", bytes);
}

inline std::string encoded_sparkplug(const std::string& text) {
  return through_protoc("encode", text);
}

}  // namespace hysteron::runtime::test
