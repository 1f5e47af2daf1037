#pragma once
// Stands in for the header of the DHD interface: declares what device/remote/example/dhd.cpp calls,
// and nothing else.
extern "C" {
#define DHD_ON 1
#define DHD_OFF 0
#define DHD_TIMEGUARD 1
int dhdOpen();
int dhdClose(char id = -1);
int dhdEnableExpertMode();
int dhdSetWatchdog(unsigned char duration, char id = -1);
int dhdEnableForce(unsigned char is_on, char id = -1);
int dhdGetSerialNumber(unsigned short* number, char id = -1);
const char* dhdGetSystemName(char id = -1);
int dhdGetPosition(double* x_m, double* y_m, double* z_m, char id = -1);
int dhdGetLinearVelocity(double* x_m_s, double* y_m_s, double* z_m_s, char id = -1);
int dhdSetForce(double x_n, double y_n, double z_n, char id = -1);
unsigned int dhdGetButtonMask(char id = -1);
const char* dhdErrorGetLastStr();
}
