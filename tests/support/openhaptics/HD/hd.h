#pragma once
// Stands in for the header of the HDAPI: declares what device/remote/example/openhaptics.cpp calls,
// and nothing else. The values are of this stand-in only.
extern "C" {
using HHD = unsigned int;
using HDenum = unsigned int;
using HDint = int;
using HDdouble = double;
using HDerror = unsigned int;
using HDushort = unsigned short;
using HDCallbackCode = unsigned int;
using HDSchedulerHandle = unsigned long;
struct HDErrorInfo {
  HDerror errorCode;
  int internalErrorCode;
  HHD hHD;
};
#define HDCALLBACK
using HDSchedulerCallback = HDCallbackCode(HDCALLBACK*)(void*);
#define HD_DEFAULT_DEVICE nullptr
#define HD_INVALID_HANDLE 0xFFFFFFFFU
#define HD_SUCCESS 0U
#define HD_CALLBACK_CONTINUE 1U
#define HD_MAX_SCHEDULER_PRIORITY 65535U
#define HD_FORCE_OUTPUT 1U
#define HD_CURRENT_POSITION 2U
#define HD_CURRENT_VELOCITY 3U
#define HD_CURRENT_BUTTONS 4U
#define HD_CURRENT_FORCE 5U
#define HD_USABLE_WORKSPACE_DIMENSIONS 6U
#define HD_NOMINAL_MAX_FORCE 7U
#define HD_NOMINAL_MAX_STIFFNESS 8U
#define HD_DEVICE_MODEL_TYPE 9U
#define HD_DEVICE_SERIAL_NUMBER 10U
HHD hdInitDevice(const char* name);
void hdDisableDevice(HHD id);
void hdMakeCurrentDevice(HHD id);
void hdEnable(HDenum capability);
void hdStartScheduler();
void hdStopScheduler();
HDSchedulerHandle hdScheduleAsynchronous(HDSchedulerCallback callback, void* data,
                                         HDushort priority);
void hdBeginFrame(HHD id);
void hdEndFrame(HHD id);
void hdGetDoublev(HDenum parameter, HDdouble* values);
void hdGetIntegerv(HDenum parameter, HDint* values);
void hdSetDoublev(HDenum parameter, const HDdouble* values);
const char* hdGetString(HDenum parameter);
HDErrorInfo hdGetError();
const char* hdGetErrorString(HDerror error);
}
