#!/usr/bin/env bash
# umockdev 0.17.16 and libusb 1.0.26 (Debian 12, umockdev 0.17.16-1, libusb-1.0-0 2:1.0.26-1): on a
# mocked USB device libusb does not sleep while a transfer is under way. It asks for finished
# transfers over and over.
#
# Seen: a bulk transfer from a device that never replies, with a timeout of 50 ms. libusb polls the
# device's node for POLLOUT and reaps (USBDEVFS_REAPURBNDELAY) when it is ready. A kernel's node is
# ready once a transfer is done. umockdev's is a plain file, which poll() calls ready at any time:
# 220 to 305 attempts to reap in 50 ms on two cores, each answered with EAGAIN. The result,
# LIBUSB_ERROR_TIMEOUT, is right. Nor does poll() say POLLERR or POLLHUP once the device was removed,
# by which libusb learns that it is gone.
#
# So a handler that counts attempts to reap, or acts on them, meets hundreds; waiting costs the
# driver a processor, and the handler's thread a round trip each time; and a mocked device that is
# unplugged must end its transfers (-ESHUTDOWN) and refuse new ones (ENODEV) by itself.
. "$(dirname "$0")/support"
unpack libumockdev0=0.17.16-1 libumockdev-dev=0.17.16-1 umockdev=0.17.16-1 \
  libusb-1.0-0=2:1.0.26-1 libusb-1.0-0-dev=2:1.0.26-1 libpcap0.8=1.10.3-1

cat >silent_device.c <<'PROGRAM'
#include <errno.h>
#include <fcntl.h>
#include <libusb-1.0/libusb.h>
#include <poll.h>
#include <stdio.h>
#include <sys/ioctl.h>
#include <linux/usbdevice_fs.h>
#include <umockdev.h>

static UMockdevIoctlData* transfer;
static int is_cancelled, reaped_in_vain;

static void submit(UMockdevIoctlData* argument) {
  transfer = umockdev_ioctl_data_resolve(argument, 0, sizeof(struct usbdevfs_urb), NULL);
}

static void cancel(void) {
  ((struct usbdevfs_urb*)transfer->data)->status = -ENOENT;
  is_cancelled = 1;
}

static int reap(UMockdevIoctlData* argument) {
  if (!is_cancelled || transfer == NULL) {
    reaped_in_vain += !is_cancelled;
    return EAGAIN;
  }
  UMockdevIoctlData* pointer = umockdev_ioctl_data_resolve(argument, 0, sizeof(void*), NULL);
  umockdev_ioctl_data_set_ptr(pointer, 0, transfer);
  g_object_unref(pointer);
  transfer = NULL;
  return 0;
}

static gboolean answer(UMockdevIoctlBase* base, UMockdevIoctlClient* client, gpointer data) {
  (void)base;
  (void)data;
  UMockdevIoctlData* argument = umockdev_ioctl_client_get_arg(client);
  int error = 0;
  switch ((guint32)umockdev_ioctl_client_get_request(client)) {
    case (guint32)USBDEVFS_GET_CAPABILITIES:
    case (guint32)USBDEVFS_CLAIMINTERFACE:
    case (guint32)USBDEVFS_RELEASEINTERFACE: break;
    case (guint32)USBDEVFS_SUBMITURB: submit(argument); break;
    case (guint32)USBDEVFS_DISCARDURB: cancel(); break;
    case (guint32)USBDEVFS_REAPURBNDELAY: error = reap(argument); break;
    default: return FALSE;
  }
  umockdev_ioctl_client_complete(client, error ? -1 : 0, error);
  return TRUE;
}

int main(void) {
  UMockdevTestbed* bed = umockdev_testbed_new();
  UMockdevIoctlBase* base = umockdev_ioctl_base_new();
  g_signal_connect(base, "handle-ioctl", G_CALLBACK(answer), NULL);
  umockdev_testbed_attach_ioctl(bed, "/dev/bus/usb/001/007", base, NULL);
  umockdev_testbed_add_from_string(
      bed,
      "P: /devices/usb1/1-1\nN: bus/usb/001/007\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\n"
      "E: BUSNUM=001\nE: DEVNUM=007\nE: DEVNAME=/dev/bus/usb/001/007\nA: busnum=1\nA: devnum=7\n"
      "A: speed=480\nA: bConfigurationValue=1\nH: descriptors="
      "12010002FF000040091201000001000000010902200001010080320904000002FF000000"
      "0705020200020007058602000200\n",
      NULL);
  libusb_device_handle* device = NULL;
  if (libusb_init(NULL) == 0) device = libusb_open_device_with_vid_pid(NULL, 0x1209, 0x0001);
  if (device == NULL || libusb_claim_interface(device, 0) != 0) return 2;
  unsigned char reply[512];
  int length = 0;
  const int result = libusb_bulk_transfer(device, 0x86, reply, sizeof reply, &length, 50);
  struct pollfd node = {.fd = open("/dev/bus/usb/001/007", O_RDWR), .events = POLLOUT};
  if (node.fd < 0) return 2;
  poll(&node, 1, 0);
  printf("%s %d %d ", libusb_error_name(result), reaped_in_vain, node.revents == POLLOUT);
  libusb_close(device);
  libusb_exit(NULL);
  umockdev_testbed_uevent(bed, "/sys/devices/usb1/1-1", "remove");
  umockdev_testbed_remove_device(bed, "/sys/devices/usb1/1-1");
  poll(&node, 1, 0);
  printf("%d\n", (node.revents & (POLLERR | POLLHUP)) != 0);
  return 0;
}
PROGRAM
read -ra glib < <(pkg-config --cflags --libs gobject-2.0)
cc -o silent_device silent_device.c -I"$root/usr/include" -I"$root/usr/include/umockdev-1.0" \
  -L"$libraries" -L"$root/lib/${libraries##*/}" -Wl,-rpath-link,"$libraries" \
  -lumockdev -lusb-1.0 "${glib[@]}"
with_libraries env LD_PRELOAD="$libraries/libumockdev-preload.so.0" timeout 20 ./silent_device >seen
read -r result reaped is_ready is_gone <seen
echo "$result after $reaped attempts to reap"
still "the transfer times out" [ "$result" = LIBUSB_ERROR_TIMEOUT ]
still "libusb reaps again and again meanwhile" [ "$reaped" -gt 10 ]
still "the node is ready with no transfer under way" [ "$is_ready" = 1 ]
still "poll() does not tell that the device was removed" [ "$is_gone" = 0 ]
