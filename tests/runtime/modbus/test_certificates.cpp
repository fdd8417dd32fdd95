#include "tests/runtime/modbus/test_certificates.hpp"

#include <openssl/asn1.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>

#include <stdexcept>

#include "runtime/modbus/tls_context.hpp"

namespace hysteron::test {
namespace {

void add_extension(X509* certificate, const X509* issuer, int kind, const char* value) {
  X509V3_CTX context;
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): the library does not write there
  X509V3_set_ctx(&context, const_cast<X509*>(issuer), certificate, nullptr, nullptr, 0);
  const std::unique_ptr<X509_EXTENSION, decltype(&X509_EXTENSION_free)> extension(
      X509V3_EXT_conf_nid(nullptr, &context, kind, value), X509_EXTENSION_free);
  X509_add_ext(certificate, extension.get(), -1);
}

/// The content of the role's extension: tag 12, a length of less than 128, the text.
std::string utf8_string(const std::string& text) {
  return std::string("\x0C") + static_cast<char>(text.size()) + text;
}

void add_role(X509* certificate, const std::string& content) {
  const std::unique_ptr<ASN1_OCTET_STRING, decltype(&ASN1_OCTET_STRING_free)> bytes(ASN1_OCTET_STRING_new(),
                                                                                    ASN1_OCTET_STRING_free);
  ASN1_OCTET_STRING_set(bytes.get(), reinterpret_cast<const unsigned char*>(content.data()),
                        static_cast<int>(content.size()));
  const std::unique_ptr<ASN1_OBJECT, decltype(&ASN1_OBJECT_free)> object(
      OBJ_txt2obj(runtime::modbus::role_extension, 1), ASN1_OBJECT_free);
  const std::unique_ptr<X509_EXTENSION, decltype(&X509_EXTENSION_free)> extension(
      X509_EXTENSION_create_by_OBJ(nullptr, object.get(), 0, bytes.get()), X509_EXTENSION_free);
  X509_add_ext(certificate, extension.get(), -1);
}

std::string text_of(BIO* memory) {
  char* bytes = nullptr;
  const long size = BIO_get_mem_data(memory, &bytes);
  return {bytes, static_cast<std::size_t>(size)};
}

}  // namespace

Certificate::Certificate(const CertificateRequest& request, const Certificate* authority)
    : key_(EVP_EC_gen("P-256"), EVP_PKEY_free), certificate_(X509_new(), X509_free) {
  X509* const made = certificate_.get();
  const X509* const issuer = authority != nullptr ? authority->certificate() : made;
  static long serial = 0;
  X509_set_version(made, X509_VERSION_3);
  ASN1_INTEGER_set(X509_get_serialNumber(made), ++serial);
  X509_gmtime_adj(X509_getm_notBefore(made), request.begins);
  X509_gmtime_adj(X509_getm_notAfter(made), request.ends);
  X509_set_pubkey(made, key_.get());
  X509_NAME_add_entry_by_txt(X509_get_subject_name(made), "CN", MBSTRING_UTF8,
                             reinterpret_cast<const unsigned char*>(request.name.c_str()), -1, -1, 0);
  X509_set_issuer_name(made, X509_get_subject_name(issuer));
  add_extension(made, issuer, NID_basic_constraints, authority != nullptr ? "critical,CA:FALSE" : "critical,CA:TRUE");
  if (authority != nullptr) {
    add_extension(made, issuer, NID_ext_key_usage, request.for_clients ? "clientAuth" : "serverAuth");
  }
  for (const std::string& role : request.roles) {
    add_role(made, utf8_string(role));
  }
  if (!request.raw_role.empty()) {
    add_role(made, request.raw_role);
  }
  if (X509_sign(made, authority != nullptr ? authority->key() : key_.get(), EVP_sha256()) == 0) {
    throw std::runtime_error("the certificate cannot be signed");
  }
}

std::string Certificate::certificate_pem() const {
  const std::unique_ptr<BIO, decltype(&BIO_free_all)> memory(BIO_new(BIO_s_mem()), BIO_free_all);
  PEM_write_bio_X509(memory.get(), certificate_.get());
  return text_of(memory.get());
}

std::string Certificate::key_pem(const std::string& password) const {
  const std::unique_ptr<BIO, decltype(&BIO_free_all)> memory(BIO_new(BIO_s_mem()), BIO_free_all);
  PEM_write_bio_PKCS8PrivateKey(memory.get(), key_.get(), password.empty() ? nullptr : EVP_aes_128_cbc(),
                                password.data(), static_cast<int>(password.size()), nullptr, nullptr);
  return text_of(memory.get());
}

}  // namespace hysteron::test
