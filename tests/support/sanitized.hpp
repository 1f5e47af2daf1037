#pragma once
// 1 where a sanitizer owns the heap and the address space.
#ifdef __has_feature  // clang's way to ask
#define TAPSTUDY_SANITIZED (__has_feature(address_sanitizer) || __has_feature(thread_sanitizer))
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TAPSTUDY_SANITIZED 1
#else
#define TAPSTUDY_SANITIZED 0
#endif
