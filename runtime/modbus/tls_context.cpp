#include "runtime/modbus/tls_context.hpp"

#include <fmt/format.h>
#include <openssl/asn1.h>
#include <openssl/err.h>
#include <openssl/objects.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <span>
#include <system_error>
#include <vector>

#include "support/errors.hpp"

namespace hysteron::runtime::modbus {
namespace {

constexpr int longest_chain = 5;                // from a client's certificate to its root
constexpr int longest_chain_bytes = 32 * 1024;  // of a client that is not known yet
constexpr std::size_t longest_role = 256;

template <auto free>
struct FreedBy {
  template <class T>
  void operator()(T* what) const {
    free(what);
  }
};
using FilePointer = std::unique_ptr<BIO, FreedBy<BIO_free_all>>;
using KeyPointer = std::unique_ptr<EVP_PKEY, FreedBy<EVP_PKEY_free>>;
using CertificatePointer = std::unique_ptr<X509, FreedBy<X509_free>>;
using ObjectPointer = std::unique_ptr<ASN1_OBJECT, FreedBy<ASN1_OBJECT_free>>;
using TextPointer = std::unique_ptr<ASN1_UTF8STRING, FreedBy<ASN1_UTF8STRING_free>>;

/// Why the library refused last, in its own words; they name no content.
std::string library_reason() {
  const unsigned long code = ERR_peek_last_error();
  const char* const text = ERR_reason_error_string(code);
  ERR_clear_error();
  return text != nullptr ? text : "no reason is given";
}

/// Nobody is there to type the password of a key.
int no_password(char* /*buffer*/, int /*size*/, int /*writes*/, void* /*user*/) {
  return -1;
}

FilePointer open(const std::string& path, const std::string& what, const Place& place) {
  FilePointer file(BIO_new_file(path.c_str(), "r"));
  if (file == nullptr) {
    const int reason = errno;
    ERR_clear_error();
    throw InputError(error::unusable_tls_file, place,
                     fmt::format("The {} {} cannot be read: {}.", what, path, std::system_category().message(reason)),
                     "name a file in PEM that is there and that the program may read.");
  }
  return file;
}

std::vector<CertificatePointer> read_certificates(const std::string& path, const std::string& what,
                                                  const Place& place) {
  const FilePointer file = open(path, what, place);
  std::vector<CertificatePointer> list;
  ERR_clear_error();
  while (CertificatePointer next{PEM_read_bio_X509(file.get(), nullptr, no_password, nullptr)}) {
    list.push_back(std::move(next));
  }
  const bool at_end = ERR_GET_REASON(ERR_peek_last_error()) == PEM_R_NO_START_LINE;
  const std::string reason = library_reason();
  if (list.empty() || !at_end) {
    throw InputError(error::unusable_tls_file, place,
                     fmt::format("The {} {} is no certificate in PEM: {}.", what, path, reason),
                     "write certificates as openssl prints them, from -----BEGIN CERTIFICATE----- on.");
  }
  return list;
}

KeyPointer read_key(const std::string& path, const Place& place) {
  if (is_open_to_others(path)) {
    throw InputError(error::key_open_to_others, place,
                     fmt::format("Others than its owner may read or change the private key {}.", path),
                     fmt::format("chmod 600 {}; if anybody could have read it, make a new key and certificate.", path));
  }
  const FilePointer file = open(path, "private key", place);
  ERR_clear_error();
  KeyPointer key(PEM_read_bio_PrivateKey(file.get(), nullptr, no_password, nullptr));
  if (key == nullptr) {
    throw InputError(error::unusable_tls_file, place,
                     fmt::format("The private key {} is not understood: {}.", path, library_reason()),
                     "write it in PEM and without a password, since nobody is there to type it.");
  }
  return key;
}

bool counts_now(const X509& certificate) {
  return X509_cmp_current_time(X509_get0_notBefore(&certificate)) < 0 &&
         X509_cmp_current_time(X509_get0_notAfter(&certificate)) > 0;
}

std::time_t seconds_of(const ASN1_TIME& time) {
  std::tm parts{};
  ASN1_TIME_to_tm(&time, &parts);
  return ::timegm(&parts);
}

std::string date_text(std::time_t time) {
  std::tm parts{};
  ::gmtime_r(&time, &parts);
  return fmt::format("{:04}-{:02}-{:02}", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday);
}

void require_now(const X509& certificate, const std::string& path, const Place& place) {
  if (!counts_now(certificate)) {
    throw InputError(error::certificate_out_of_date, place,
                     fmt::format("The certificate {} counts from {} to {}, and not today.", path,
                                 date_text(seconds_of(*X509_get0_notBefore(&certificate))),
                                 date_text(seconds_of(*X509_get0_notAfter(&certificate)))),
                     "have a new one signed; where the date of this machine is wrong, set its clock.");
  }
}

Validity validity_of(const X509& certificate) {
  return {.begins = seconds_of(*X509_get0_notBefore(&certificate)),
          .ends = seconds_of(*X509_get0_notAfter(&certificate))};
}

struct OwnCertificate {
  std::vector<CertificatePointer> chain{};
  KeyPointer key{};
};

/// A certificate, with those behind it and its key.
OwnCertificate read_own_certificate(const std::string& path, const Place& place, const std::string& key_path,
                                    const Place& key_place, OutOfDate out_of_date) {
  OwnCertificate own{.chain = read_certificates(path, "certificate", place)};
  if (out_of_date == OutOfDate::refused) {
    require_now(*own.chain.front(), path, place);
  }
  own.key = read_key(key_path, key_place);
  if (X509_check_private_key(own.chain.front().get(), own.key.get()) != 1) {
    ERR_clear_error();
    throw InputError(error::key_of_another_certificate, key_place,
                     fmt::format("The private key {} is not that of the certificate {}.", key_path, path),
                     "name the key that the certificate was asked for with.");
  }
  return own;
}

/// Gives back when it counts.
Validity use_server_certificate(SSL_CTX& context, const TlsOptions& options, OutOfDate out_of_date) {
  const std::string path = credential_path(options.certificate, certificate_credential);
  const auto [chain, key] =
      read_own_certificate(path, options.certificate_place, credential_path(options.key, key_credential),
                           options.key_place, out_of_date);
  bool taken =
      SSL_CTX_use_certificate(&context, chain.front().get()) == 1 && SSL_CTX_use_PrivateKey(&context, key.get()) == 1;
  for (std::size_t i = 1; taken && i < chain.size(); ++i) {
    taken = SSL_CTX_add1_chain_cert(&context, chain[i].get()) == 1;
  }
  if (!taken) {
    throw InputError(error::unusable_tls_file, options.certificate_place,
                     fmt::format("The certificate {} does not serve: {}.", path, library_reason()),
                     "have one signed for a key of today's strength: RSA of 2048 bits, or an elliptic curve.");
  }
  return validity_of(*chain.front());
}

/// Gives back when each of those who sign counts.
std::vector<Validity> trust_clients_of(SSL_CTX& context, const TlsOptions& options, OutOfDate out_of_date) {
  const std::string path = credential_path(options.clients, clients_credential);
  const auto list = read_certificates(path, "file of those who sign clients' certificates", options.clients_place);
  bool any = false;
  std::vector<Validity> signers;
  for (const CertificatePointer& one : list) {
    any = any || counts_now(*one);
    signers.push_back(validity_of(*one));
    X509_STORE_add_cert(SSL_CTX_get_cert_store(&context), one.get());
    SSL_CTX_add_client_CA(&context, one.get());
  }
  if (!any && out_of_date == OutOfDate::refused) {
    require_now(*list.front(), path, options.clients_place);
  }
  return signers;
}

/// One role; nothing where the certificate has none. `is_one` is false where the extension is there and is no role.
std::optional<std::string> role_of(const X509& certificate, bool& is_one) {
  const ObjectPointer object(OBJ_txt2obj(role_extension, 1));
  const int at = X509_get_ext_by_OBJ(&certificate, object.get(), -1);
  is_one = at < 0;
  if (at < 0) {
    return std::nullopt;
  }
  const ASN1_OCTET_STRING* const data = X509_EXTENSION_get_data(X509_get_ext(&certificate, at));
  const unsigned char* next = ASN1_STRING_get0_data(data);
  const unsigned char* const end = next + ASN1_STRING_length(data);
  const TextPointer text(d2i_ASN1_UTF8STRING(nullptr, &next, ASN1_STRING_length(data)));
  ERR_clear_error();
  if (text == nullptr || next != end || X509_get_ext_by_OBJ(&certificate, object.get(), at) >= 0) {
    return std::nullopt;
  }
  const std::span bytes(ASN1_STRING_get0_data(text.get()), static_cast<std::size_t>(ASN1_STRING_length(text.get())));
  std::string role(bytes.begin(), bytes.end());
  if (role.empty() || role.size() > longest_role || role.find('\0') != std::string::npos) {
    return std::nullopt;
  }
  is_one = true;
  return role;
}

}  // namespace

std::string credential_path(const std::string& path, const char* credential) {
  const char* const folder = std::getenv("CREDENTIALS_DIRECTORY");
  if (folder != nullptr) {
    const auto given = std::filesystem::path(folder) / credential;
    std::error_code ignored;
    if (std::filesystem::exists(given, ignored)) {
      return given.string();
    }
  }
  return path;
}

bool is_open_to_others(const std::string& path) {
  struct stat status {};
  // Its group may read it: Debian's ssl-cert is for that.
  return ::stat(path.c_str(), &status) == 0 && (status.st_mode & (S_IRWXO | S_IWGRP | S_IXGRP)) != 0;
}

void check_client_files(const TlsClientFiles& files) {
  const auto authorities =
      read_certificates(files.authority, "file of those who sign the broker's certificate", files.authority_place);
  if (std::ranges::none_of(authorities, [](const CertificatePointer& one) { return counts_now(*one); })) {
    require_now(*authorities.front(), files.authority, files.authority_place);
  }
  if (!files.certificate.empty()) {
    (void)read_own_certificate(files.certificate, files.certificate_place, files.key, files.key_place,
                               OutOfDate::refused);
  }
}

std::vector<std::string> files_of(const TlsOptions& options) {
  return {credential_path(options.certificate, certificate_credential), credential_path(options.key, key_credential),
          credential_path(options.clients, clients_credential)};
}

void TlsContext::Free::operator()(ssl_ctx_st* context) const {
  SSL_CTX_free(context);
}

TlsContext::TlsContext(const TlsOptions& options, OutOfDate out_of_date)
    : context_(SSL_CTX_new(TLS_server_method())), roles_(options.roles), without_role_(options.without_role) {
  if (context_ == nullptr) {
    throw std::runtime_error("TLS: " + library_reason());
  }
  SSL_CTX& context = *context_;
  SSL_CTX_set_min_proto_version(&context, TLS1_2_VERSION);
  SSL_CTX_set_cipher_list(&context, "ECDHE+AESGCM:ECDHE+CHACHA20");  // of TLS 1.2; 1.3 has none that is weak
  SSL_CTX_set_options(
      &context, SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION | SSL_OP_CIPHER_SERVER_PREFERENCE | SSL_OP_NO_TICKET);
  // Every connection shows its certificate anew: what has expired meanwhile does not come back by resumption.
  SSL_CTX_set_session_cache_mode(&context, SSL_SESS_CACHE_OFF);
  SSL_CTX_set_num_tickets(&context, 0);
  // One record a call, so that a flood of records that carry nothing ends a call.
  SSL_CTX_clear_mode(&context, SSL_MODE_AUTO_RETRY);
  SSL_CTX_set_verify(&context, SSL_VERIFY_PEER | SSL_VERIFY_FAIL_IF_NO_PEER_CERT, nullptr);
  SSL_CTX_set_verify_depth(&context, longest_chain);
  SSL_CTX_set_max_cert_list(&context, longest_chain_bytes);
  validity_ = use_server_certificate(context, options, out_of_date);
  signers_ = trust_clients_of(context, options, out_of_date);
}

TlsFault TlsContext::fault_at(std::time_t now) const {
  const auto counts = [now](const Validity& one) { return one.begins <= now && now < one.ends; };
  return now >= validity_.ends                    ? TlsFault::ended
         : now < validity_.begins                 ? TlsFault::not_begun
         : !std::ranges::any_of(signers_, counts) ? TlsFault::signers
                                                  : TlsFault::none;
}

std::string TlsContext::valid_until() const {
  return date_text(validity_.ends);
}

Rights TlsContext::rights_of(const x509_st& certificate) const {
  bool is_one = false;
  const auto role = role_of(certificate, is_one);
  if (!role) {
    return is_one ? without_role_ : no_rights;
  }
  const auto listed = roles_.find(*role);
  return listed == roles_.end() ? no_rights : listed->second;
}

}  // namespace hysteron::runtime::modbus
