#include "support/usb/fake_bus.hpp"

#include <link.h>
#include <linux/usbdevice_fs.h>
#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstring>
#include <ctime>
#include <map>
#include <string_view>
#include <utility>
namespace tapstudy::testing {
namespace {
constexpr std::uint64_t full = 0xFFFFFFFFFFFFFFFEULL;  // an eventfd that cannot be written to
constexpr unsigned address = 7;

std::mutex buses_mutex;
std::map<int, FakeBus*>& buses() {
  static std::map<int, FakeBus*> all;
  return all;
}

using std::chrono::nanoseconds;
std::atomic<nanoseconds> bus_time{std::chrono::seconds{1000}};
nanoseconds bus_now() {
  return bus_time;
}

// Whether a function was called by libusb.
bool is_in_libusb(const void* return_address) {
  using Range = std::pair<ElfW(Addr), ElfW(Addr)>;
  static const Range libusb = [] {
    Range range{};
    dl_iterate_phdr(
        [](dl_phdr_info* object, std::size_t /*size*/, void* found) {
          if (std::string_view{object->dlpi_name}.find("libusb-1.0") == std::string_view::npos) {
            return 0;
          }
          ElfW(Addr) end = 0;
          for (int i = 0; i < object->dlpi_phnum; ++i) {
            const auto& part = object->dlpi_phdr[i];
            end = part.p_type == PT_LOAD ? std::max(end, part.p_vaddr + part.p_memsz) : end;
          }
          *static_cast<Range*>(found) = {object->dlpi_addr, object->dlpi_addr + end};
          return 1;
        },
        &range);
    return range;
  }();
  const auto caller = reinterpret_cast<ElfW(Addr)>(return_address);
  return libusb.first <= caller && caller < libusb.second;
}

// A forked process that waits for a reply asks so often; the bus's time passes meanwhile.
constexpr std::chrono::microseconds between_reads{200};
int generation = 0;  // of processes, counted from the test program on

// A transfer of a forked process, there and back.
struct Forwarded {
  unsigned long request;
  unsigned endpoint;
  unsigned length;
  int result;
  std::array<std::uint8_t, 512> bytes;
};
}  // namespace

FakeBus::FakeBus(std::uint16_t vendor, std::uint16_t product, Answer answer)
    : descriptor_{eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)},
      descriptors_{descriptors_of(vendor, product)},
      answer_{std::move(answer)},
      usbfs_{*this, address, bus_now},
      generation_{generation} {
  static const int is_counted = pthread_atfork(nullptr, nullptr, [] { ++generation; });
  static_cast<void>(is_counted);
  socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, line_.data());
  answering_ = std::thread{[this] { answer_forked_processes(); }};
  const std::lock_guard lock{buses_mutex};
  buses()[descriptor_] = this;
}

FakeBus::~FakeBus() {
  shutdown(line_[0], SHUT_RDWR);
  answering_.join();
  close(line_[0]);
  close(line_[1]);
  const std::lock_guard lock{buses_mutex};
  buses().erase(descriptor_);
  if (!is_open_) {
    close(descriptor_);
  }
}

int FakeBus::open() {
  is_open_ = true;
  return descriptor_;
}

FakeBus* FakeBus::of(int descriptor) {
  const std::lock_guard lock{buses_mutex};
  const auto found = buses().find(descriptor);
  return found == buses().end() ? nullptr : found->second;
}

void FakeBus::plan(Trouble trouble, int after, std::chrono::milliseconds delay) {
  const std::lock_guard lock{mutex_};
  usbfs_.plan(trouble, after, delay);
}

void FakeBus::persist_in(Trouble trouble) {
  const std::lock_guard lock{mutex_};
  usbfs_.persist_in(trouble);
}

void FakeBus::reply_after(nanoseconds delay) {
  const std::lock_guard lock{mutex_};
  usbfs_.reply_after(delay);
}

std::int64_t FakeBus::now() noexcept {
  return bus_now().count();
}

void FakeBus::pass_to(std::int64_t moment) noexcept {
  bus_time = std::max(bus_now(), nanoseconds{moment});
}

void FakeBus::halt_out(int clears) {
  const std::lock_guard lock{mutex_};
  usbfs_.halt_out(clears);
}

std::vector<Bytes> FakeBus::requests() const {
  const std::lock_guard lock{mutex_};
  return requests_;
}

void FakeBus::forget_requests() {
  const std::lock_guard lock{mutex_};
  requests_.clear();
}

void FakeBus::unplug() {
  const std::lock_guard lock{mutex_};
  usbfs_.unplug();
  show_news();
}

// libusb waits for the descriptor to become writable.
void FakeBus::show_news() {
  std::uint64_t value = full;
  if (usbfs_.has_news() && is_blocked_) {
    is_blocked_ = syscall(SYS_read, descriptor_, &value, sizeof value) != sizeof value;
  } else if (!usbfs_.has_news() && !is_blocked_) {
    is_blocked_ = syscall(SYS_write, descriptor_, &value, sizeof value) == sizeof value;
  }
}

Bytes FakeBus::answer(std::span<const std::uint8_t> request) {
  if (keeps_requests_) {
    requests_.emplace_back(request.begin(), request.end());
  }
  return answer_(request);
}

void FakeBus::answer_forked_processes() {
  Forwarded asked{};
  while (recv(line_[0], &asked, sizeof asked, 0) == sizeof asked) {
    {
      const std::lock_guard lock{mutex_};
      usbdevfs_bulktransfer transfer{asked.endpoint, asked.length, 0, asked.bytes.data()};
      bus_time = bus_now() + between_reads;
      asked.result = usbfs_.ioctl(asked.request, &transfer);
      show_news();
    }
    send(line_[0], &asked, sizeof asked, MSG_NOSIGNAL);
  }
}

// The kernel waits for a reply as long as the transfer says. No lock: in a forked process nobody
// may be left to release it.
int FakeBus::ask_from_forked_process(unsigned long request, void* argument) {
  close(std::exchange(line_[0], -1));  // or the test program's end would go unnoticed
  auto* const transfer =
      request == USBDEVFS_BULK ? static_cast<usbdevfs_bulktransfer*>(argument) : nullptr;
  Forwarded asked{request, 0, 0, 0, {}};
  if (transfer != nullptr) {
    asked.endpoint = transfer->ep;
    asked.length = transfer->len;
    std::memcpy(asked.bytes.data(), transfer->data, transfer->len);
  }
  const bool is_read = asked.endpoint == in_endpoint;
  const std::chrono::milliseconds patience{is_read ? transfer->timeout : 0};
  for (std::chrono::microseconds waited{0};; waited += between_reads) {
    if (send(line_[1], &asked, sizeof asked, MSG_NOSIGNAL) < 0 ||
        recv(line_[1], &asked, sizeof asked, 0) != sizeof asked) {
      return -ENODEV;
    }
    if (!is_read || asked.result != -ETIMEDOUT || waited >= patience) {
      break;
    }
    usleep(between_reads.count());
  }
  if (is_read && asked.result > 0) {
    std::memcpy(transfer->data, asked.bytes.data(), static_cast<std::size_t>(asked.result));
  }
  const bool is_copied = is_read || transfer == nullptr || plain_bulk_copy_ < 0 ||
                         asked.result < 0 ||
                         write(plain_bulk_copy_, transfer->data, transfer->len) >= 0;
  return is_copied ? asked.result : -EIO;
}

int FakeBus::ioctl(unsigned long request, void* argument) {
  int result = 0;
  if (generation_ != generation && (request == USBDEVFS_BULK || request == USBDEVFS_CLEAR_HALT)) {
    result = ask_from_forked_process(request, argument);
  } else {
    const std::lock_guard lock{mutex_};
    result = usbfs_.ioctl(request, argument);
    show_news();
  }
  if (result < 0) {
    errno = -result;
    return -1;
  }
  return result;
}

std::int64_t FakeBus::read(void* to, std::size_t size) {
  const std::lock_guard lock{mutex_};
  const std::size_t count = std::min(size, descriptors_.size() - read_at_);
  std::memcpy(to, descriptors_.data() + read_at_, count);
  read_at_ += count;
  return static_cast<std::int64_t>(count);
}

// Wakes for replies that are due meanwhile, and tells of an unplugged device as the kernel does.
int FakeBus::poll(pollfd* all, unsigned long count, nanoseconds time_out) {
  const nanoseconds end = bus_now() + time_out;
  const std::lock_guard lock{mutex_};
  while (true) {
    usbfs_.deliver_what_is_due();
    show_news();
    const auto ready = static_cast<int>(syscall(SYS_poll, all, count, 0));
    if (ready == 0 && bus_now() < end) {
      bus_time = usbfs_.has_reply_under_way() ? std::min(end, usbfs_.next_reply_due()) : end;
      continue;
    }
    for (unsigned long i = 0; usbfs_.is_gone() && ready > 0 && i < count; ++i) {
      if (all[i].fd == descriptor_ && all[i].revents != 0) {
        all[i].revents = static_cast<short>(all[i].revents | POLLERR | POLLHUP);
      }
    }
    return ready;
  }
}
}  // namespace tapstudy::testing

using tapstudy::testing::FakeBus;

// The shared library of libusb finds these before the C library's.
extern "C" {
int ioctl(int descriptor, unsigned long request, ...) noexcept {
  va_list arguments;
  va_start(arguments, request);
  void* const argument = va_arg(arguments, void*);
  va_end(arguments);
  FakeBus* const bus = FakeBus::of(descriptor);
  return bus != nullptr ? bus->ioctl(request, argument)
                        : static_cast<int>(syscall(SYS_ioctl, descriptor, request, argument));
}
ssize_t read(int descriptor, void* to, std::size_t size) {
  FakeBus* const bus = FakeBus::of(descriptor);
  return bus != nullptr ? bus->read(to, size) : syscall(SYS_read, descriptor, to, size);
}
int poll(struct pollfd* all, nfds_t count, int time_out_ms) {
  for (nfds_t i = 0; i < count; ++i) {
    if (FakeBus* const bus = FakeBus::of(all[i].fd)) {
      return bus->poll(all, count,
                       std::chrono::milliseconds{time_out_ms < 0 ? 60'000 : time_out_ms});
    }
  }
  return static_cast<int>(syscall(SYS_poll, all, count, time_out_ms));
}
int ppoll(struct pollfd* all, nfds_t count, const struct timespec* time_out,
          const sigset_t* signals) {
  for (nfds_t i = 0; i < count; ++i) {
    if (FakeBus* const bus = FakeBus::of(all[i].fd)) {
      return bus->poll(
          all, count,
          std::chrono::seconds{time_out->tv_sec} + std::chrono::nanoseconds{time_out->tv_nsec});
    }
  }
  timespec left = time_out != nullptr ? *time_out : timespec{};  // the kernel writes to it
  constexpr std::size_t signal_set_bytes = 8;
  return static_cast<int>(syscall(SYS_ppoll, all, count, time_out != nullptr ? &left : nullptr,
                                  signals, signal_set_bytes));
}
int clock_gettime(clockid_t clock, struct timespec* time) noexcept {
  using namespace tapstudy::testing;
  if (!is_in_libusb(__builtin_return_address(0))) {
    return static_cast<int>(syscall(SYS_clock_gettime, clock, time));
  }
  const auto now = bus_now();
  const auto whole = std::chrono::floor<std::chrono::seconds>(now);
  *time = {whole.count(), (now - whole).count()};
  return 0;
}
// Without it libusb computes its own time-outs by the clock above.
int timerfd_create(int clock, int flags) noexcept {
  if (!tapstudy::testing::is_in_libusb(__builtin_return_address(0))) {
    return static_cast<int>(syscall(SYS_timerfd_create, clock, flags));
  }
  errno = ENOSYS;
  return -1;
}
}
