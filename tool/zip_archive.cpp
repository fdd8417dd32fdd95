#include "tool/zip_archive.hpp"

#include <zip.h>

#include <memory>
#include <stdexcept>

namespace hysteron {
namespace {

constexpr zip_uint16_t midnight = 0;
constexpr zip_uint16_t first_of_january_1980 = (1U << 5U) | 1U;
constexpr zip_uint32_t regular_file_rw_r_r = 0100644U << 16U;

struct Discard {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};
struct Free {
  void operator()(zip_source_t* source) const { zip_source_free(source); }
};

void require(bool done, const std::string& what) {
  if (!done) {
    throw std::runtime_error("zip archive: " + what);
  }
}

void add(zip_t* archive, const ArchivedFile& file) {
  zip_source_t* const contents = zip_source_buffer(archive, file.contents.data(), file.contents.size(), 0);
  require(contents != nullptr, zip_strerror(archive));
  const zip_int64_t place = zip_file_add(archive, file.name.c_str(), contents, ZIP_FL_ENC_UTF_8);
  if (place < 0) {
    zip_source_free(contents);
    require(false, file.name + ": " + zip_strerror(archive));
  }
  const auto index = static_cast<zip_uint64_t>(place);
  const bool set = zip_file_set_dostime(archive, index, midnight, first_of_january_1980, 0) == 0 &&
                   zip_file_set_external_attributes(archive, index, 0, ZIP_OPSYS_UNIX, regular_file_rw_r_r) == 0 &&
                   zip_set_file_compression(archive, index, file.plain ? ZIP_CM_STORE : ZIP_CM_DEFLATE, 0) == 0;
  require(set, file.name + ": " + zip_strerror(archive));
}

}  // namespace

std::string zip_archive(const std::vector<ArchivedFile>& files) {
  zip_error_t error;
  zip_error_init(&error);
  const std::unique_ptr<zip_source_t, Free> bytes(zip_source_buffer_create(nullptr, 0, 0, &error));
  require(bytes != nullptr, zip_error_strerror(&error));
  std::unique_ptr<zip_t, Discard> archive(zip_open_from_source(bytes.get(), ZIP_TRUNCATE, &error));
  require(archive != nullptr, zip_error_strerror(&error));
  zip_source_keep(bytes.get());  // zip_close gives its own hold away
  for (const ArchivedFile& file : files) {
    add(archive.get(), file);
  }
  require(zip_close(archive.get()) == 0, zip_strerror(archive.get()));
  (void)archive.release();  // closed

  zip_stat_t about;
  require(zip_source_stat(bytes.get(), &about) == 0 && zip_source_open(bytes.get()) == 0, "cannot be read back");
  std::string text(about.size, '\0');
  const zip_int64_t read = zip_source_read(bytes.get(), text.data(), text.size());
  zip_source_close(bytes.get());
  require(read >= 0 && static_cast<std::size_t>(read) == text.size(), "cannot be read back");
  return text;
}

}  // namespace hysteron
