#include "runtime/modbus/connection.hpp"

#include <algorithm>

namespace hysteron::runtime::modbus {

Served Connection::received(std::span<const std::uint8_t> bytes, Instant now, Responder& responder,
                            const Caller& caller) {
  const std::size_t count = std::min(bytes.size(), input_.size() - input_size_);
  std::copy_n(bytes.begin(), count, input_.begin() + static_cast<std::ptrdiff_t>(input_size_));
  input_size_ += count;
  return resume(now, responder, caller);
}

Served Connection::resume(Instant now, Responder& responder, const Caller& caller) {
  Served served;
  std::size_t taken = 0;
  while (!ending_ && output_size() < limits_.output_bytes) {
    const FrameScan scan = scan_frame(std::span(input_).subspan(taken, input_size_ - taken));
    if (scan.status == FrameStatus::wrong_protocol || scan.status == FrameStatus::wrong_length) {
      ending_ = scan.status == FrameStatus::wrong_protocol ? Ending::wrong_protocol : Ending::wrong_length;
      break;
    }
    if (scan.status == FrameStatus::incomplete) {
      break;
    }
    const Reply reply = responder.answer(scan.frame.pdu, caller);
    const auto header = header_of(scan.frame, reply.size);
    if (output_size() == 0) {
      output_waits_ = now;
    }
    output_.insert(output_.end(), header.begin(), header.end());
    output_.insert(output_.end(), reply.pdu().begin(), reply.pdu().end());
    taken += scan.size;
    last_request_ = now;
    frame_began_.reset();
    served.count(reply);
  }
  std::copy(input_.begin() + static_cast<std::ptrdiff_t>(taken),
            input_.begin() + static_cast<std::ptrdiff_t>(input_size_), input_.begin());
  input_size_ -= taken;
  // While the output is full the rest may hold whole requests, and it is not the client's bytes that are late.
  if (input_size_ == 0 || output_size() >= limits_.output_bytes) {
    frame_began_.reset();
  } else if (!frame_began_) {
    frame_began_ = now;
  }
  return served;
}

void Connection::sent(std::size_t count, Instant now) {
  output_sent_ += count;
  if (count > 0) {
    output_waits_ = now;
  }
  if (output_size() == 0) {
    output_.clear();
    output_sent_ = 0;
    output_waits_.reset();
  } else if (output_sent_ >= limits_.output_bytes) {
    output_.erase(output_.begin(), output_.begin() + static_cast<std::ptrdiff_t>(output_sent_));
    output_sent_ = 0;
  }
}

std::optional<Ending> Connection::due(Instant now) const {
  if (ending_) {
    return ending_;
  }
  if (frame_began_ && now >= *frame_began_ + limits_.frame_deadline) {
    return Ending::frame_late;
  }
  if (output_waits_ && now >= *output_waits_ + limits_.unread) {
    return Ending::unread;
  }
  if (now >= last_request_ + limits_.idle) {
    return Ending::idle;
  }
  return std::nullopt;
}

Instant Connection::next_deadline() const {
  Instant next = last_request_ + limits_.idle;
  if (frame_began_) {
    next = std::min(next, *frame_began_ + limits_.frame_deadline);
  }
  if (output_waits_) {
    next = std::min(next, *output_waits_ + limits_.unread);
  }
  return next;
}

}  // namespace hysteron::runtime::modbus
