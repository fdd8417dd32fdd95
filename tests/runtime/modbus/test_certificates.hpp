// Certificates for tests, made when they are needed: an authority, and what it signs.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct evp_pkey_st;
struct x509_st;

namespace hysteron::test {

struct CertificateRequest {
  std::string name = "client";
  std::vector<std::string> roles{};  ///< an extension with a UTF8String each
  std::string raw_role{};            ///< the content of the extension, as it is
  long begins = -3600;               ///< seconds from now
  long ends = 3600;
  bool for_clients = true;  ///< else for servers
};

class Certificate {
 public:
  /// Signed by its own key where there is no authority.
  Certificate(const CertificateRequest& request, const Certificate* authority);

  [[nodiscard]] std::string certificate_pem() const;
  /// With a password where one is given.
  [[nodiscard]] std::string key_pem(const std::string& password = {}) const;
  [[nodiscard]] x509_st* certificate() const { return certificate_.get(); }
  [[nodiscard]] evp_pkey_st* key() const { return key_.get(); }

 private:
  std::shared_ptr<evp_pkey_st> key_;
  std::shared_ptr<x509_st> certificate_;
};

}  // namespace hysteron::test
