/* The one exception of the C++ interface. Part of cscd/cscd.hpp, which says what holds for all. */
#ifndef CSCD_ERROR_HPP
#define CSCD_ERROR_HPP

#include <cscd/detector.h>

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>

namespace cscd {

/* A call has failed: its status, and in what() the sentence of cscd_context_detail. */
class error : public std::runtime_error {
  public:
    error(cscd_status status, const std::string &sentence, std::size_t count = 0)
        : std::runtime_error(sentence), status_(status), count_(count) {
    }
    error(cscd_status status, const std::string &sentence, const cscd_contact &contact)
        : std::runtime_error(sentence), status_(status), contact_(contact) {
    }

    cscd_status status() const noexcept {
        return status_;
    }

    /* CSCD_IN_CONTACT: the pair that touches. Else NULL. */
    const cscd_contact *contact() const noexcept {
        return contact_ ? &*contact_ : nullptr;
    }

    /* Of a list that has become too long: how many items there are. Else 0. */
    std::size_t count() const noexcept {
        return count_;
    }

  private:
    cscd_status status_;
    std::size_t count_ = 0;
    std::optional<cscd_contact> contact_;
};

} // namespace cscd

#endif
