/* SPDX-License-Identifier: Apache-2.0 */
/* Stands for libdhd.so of Force Dimension: the functions that the driver uses, with a device that a test moves. With the
   variable FAKE_DEVICE_MOVES the device moves by itself: up and down once a second. */
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static double place[3], turn[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, force[6];
static unsigned buttons;
static int type = 104, is_calibrated = 1, is_lost, hangs, is_nan, force_on, opened, watchdog, largest_force;
static int forces_before_enable;
static unsigned short number = 4711;

/* ---- the test's side ---- */
void fake_reset(void) {
    pthread_mutex_lock(&lock);
    memset(place, 0, sizeof place);
    memset(force, 0, sizeof force);
    const double unit[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    memcpy(turn, unit, sizeof turn);
    buttons = 0;
    type = 104;
    is_calibrated = 1;
    is_lost = hangs = is_nan = force_on = watchdog = forces_before_enable = 0;
    number = 4711;
    pthread_mutex_unlock(&lock);
}
void fake_place(const double* p, const double* rows) {
    pthread_mutex_lock(&lock);
    memcpy(place, p, sizeof place);
    memcpy(turn, rows, sizeof turn);
    pthread_mutex_unlock(&lock);
}
void fake_buttons(unsigned mask) { buttons = mask; }
void fake_hang(int on) { hangs = on; }
void fake_lose(int on) {
    pthread_mutex_lock(&lock);
    is_lost = on;
    memset(force, 0, sizeof force); /* a device without current */
    pthread_mutex_unlock(&lock);
}
void fake_nan(int on) { is_nan = on; }
void fake_type(int t) { type = t; }
void fake_number(int n) { number = (unsigned short)n; }
void fake_calibrate(int on) { is_calibrated = on; }
void fake_given(double* six) {
    pthread_mutex_lock(&lock);
    memcpy(six, force, sizeof force);
    pthread_mutex_unlock(&lock);
}
int fake_watchdog(void) { return watchdog; }
int fake_force_on(void) { return force_on; }
int fake_is_open(void) { return opened; }
int fake_forces_before_enable(void) { return forces_before_enable; }

/* ---- the vendor's side ---- */
static double seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}
static void wait_while_hung(void) {
    while (__atomic_load_n(&hangs, __ATOMIC_SEQ_CST)) {
        const struct timespec t = {0, 1000000};
        nanosleep(&t, NULL);
    }
}
int dhdGetDeviceCount(void) { return is_lost ? 0 : 1; }
int dhdOpenID(char id) {
    wait_while_hung();
    if (is_lost || id != 0) return -1;
    opened = 1;
    return 0;
}
int dhdOpenSerial(int wanted) { return wanted == number ? dhdOpenID(0) : -1; }
int dhdClose(char id) {
    (void)id;
    opened = 0;
    return 0;
}
int dhdStop(char id) {
    (void)id;
    force_on = 0;
    return 0;
}
int dhdGetSystemType(char id) {
    (void)id;
    return type;
}
const char* dhdGetSystemName(char id) {
    (void)id;
    return type == 60 ? "FALCON" : "sigma.7";
}
int dhdGetSerialNumber(unsigned short* sn, char id) {
    (void)id;
    *sn = number;
    return 0;
}
void dhdGetSDKVersion(int* a, int* b, int* c, int* d) {
    *a = 3, *b = 17, *c = 5, *d = 0;
}
const char* dhdErrorGetLastStr(void) { return is_lost ? "no device found" : "no error"; }
int dhdEnableForce(unsigned char on, char id) {
    (void)id;
    force_on = on;
    return 0;
}
int dhdGetStatus(int* status, char id) {
    (void)id;
    if (is_lost) return -1;
    for (int i = 0; i < 64; ++i) status[i] = -1; /* as a later SDK, which has more to say than 17 places */
    status[3] = is_calibrated;
    status[5] = force_on;
    return 0;
}
int dhdGetPositionAndOrientationFrame(double* x, double* y, double* z, double rows[3][3], char id) {
    (void)id;
    wait_while_hung();
    if (is_lost) return -1;
    pthread_mutex_lock(&lock);
    *x = is_nan ? NAN : place[0], *y = place[1], *z = place[2];
    memcpy(rows, turn, sizeof turn);
    pthread_mutex_unlock(&lock);
    if (getenv("FAKE_DEVICE_MOVES")) *z = -0.02 * (1.0 - cos(6.283185307179586 * seconds()));
    return 0;
}
static int take(const double* six) {
    if (is_lost) return -1;
    pthread_mutex_lock(&lock);
    memcpy(force, six, sizeof force);
    for (int i = 0; i < 6; ++i)
        if (!force_on && six[i] != 0.0) ++forces_before_enable;
    pthread_mutex_unlock(&lock);
    return 0;
}
int dhdSetForce(double x, double y, double z, char id) {
    (void)id;
    const double six[6] = {x, y, z, 0, 0, 0};
    return take(six);
}
#ifndef FAKE_WITHOUT_TORQUE
int dhdSetForceAndTorqueAndGripperForce(double x, double y, double z, double a, double b, double c, double g, char id) {
    (void)id, (void)g;
    const double six[6] = {x, y, z, a, b, c};
    return take(six);
}
#endif
unsigned dhdGetButtonMask(char id) {
    (void)id;
    return buttons;
}
int dhdSetMaxForce(double f, char id) {
    (void)id;
    largest_force = (int)f;
    return 0;
}
int dhdSetGravityCompensation(int on, char id) {
    (void)on, (void)id;
    return 0;
}
_Bool dhdHasActiveWrist(char id) {
    (void)id;
    return type == 104;
}
int dhdEnableExpertMode(void) { return 0; }
int dhdDisableExpertMode(void) { return 0; }
int dhdSetWatchdog(unsigned char ticks, char id) {
    (void)id;
    watchdog = ticks;
    return 0;
}
