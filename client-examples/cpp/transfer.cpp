#include "transfer.h"

#include <openssl/evp.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "failure.h"

namespace lpf_client {

Upload::Upload(const std::string& path) : file_(path, std::ios::binary) {
    std::error_code error;
    size_ = std::filesystem::file_size(path, error);
    if (!file_ || error) throw Failure(Exit::BadFile, path + " cannot be read");
}

std::string Upload::read(std::uint64_t offset, std::uint64_t length) {
    std::string block(std::min<std::uint64_t>(length, 1 << 16), '\0');
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(offset));
    file_.read(block.data(), static_cast<std::streamsize>(block.size()));
    block.resize(static_cast<std::size_t>(std::max<std::streamsize>(file_.gcount(), 0)));
    return block;
}

struct Download::Hash {
    EVP_MD_CTX* context = EVP_MD_CTX_new();
    Hash() = default;
    Hash(const Hash&) = delete;
    Hash& operator=(const Hash&) = delete;
    ~Hash() { EVP_MD_CTX_free(context); }

    std::string hex() const {
        unsigned char digest[EVP_MAX_MD_SIZE];
        unsigned length = 0;
        EVP_DigestFinal_ex(context, digest, &length);
        std::string text;
        for (unsigned i = 0; i < length; ++i) {
            for (const int digit : {digest[i] >> 4, digest[i] & 15}) {
                text += "0123456789abcdef"[digit];
            }
        }
        return text;
    }
};

Download::Download(std::string path)
    : path_(std::move(path)),
      part_(path_ + "." + std::to_string(getpid()) + ".part"),
      hash_(std::make_unique<Hash>()) {
    restart();
}

Download::~Download() {
    file_.close();
    std::remove(part_.c_str());
}

void Download::restart() {
    if (file_.is_open()) file_.close();
    file_.open(part_, std::ios::binary | std::ios::trunc);
    if (!file_) throw Failure(Exit::CannotSave, path_ + " cannot be written");
    size_ = 0;
    EVP_DigestInit_ex(hash_->context, EVP_sha256(), nullptr);
}

void Download::write(const char* data, std::size_t size) {
    file_.write(data, static_cast<std::streamsize>(size));
    EVP_DigestUpdate(hash_->context, data, size);
    size_ += size;
}

void Download::keep(const std::string& sha256) {
    file_.close();
    if (!file_) throw Failure(Exit::CannotSave, path_ + " cannot be written; is the disk full?");
    if (hash_->hex() != sha256) {
        throw Failure(Exit::CannotSave,
                      path_ + " was not written: what came has another SHA-256 than announced");
    }
    if (std::rename(part_.c_str(), path_.c_str()) != 0) {
        throw Failure(Exit::CannotSave, path_ + " cannot be written");
    }
}

}  // namespace lpf_client
