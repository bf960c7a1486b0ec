/* SPDX-License-Identifier: Apache-2.0 */
/* Stands for libHD.so of OpenHaptics: the functions that the driver uses, with a servo thread at 1 kHz and a device that
   a test moves. State counts inside of a frame only, as with the vendor's. With the variable FAKE_DEVICE_MOVES the
   device moves by itself. */
#include <locale.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct {
    unsigned code;
    int internal;
    unsigned device;
} Error;

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static double transform[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, force[6], next_force[6];
static int buttons, is_lost, hangs, is_nan, is_calibrated = 1, force_on, in_frame, runs, must_stop, needs_update;
static int forces_outside, most_errors;
static unsigned errors[16];
static int error_count;
static unsigned (*callback)(void*);
static void* data;
static pthread_t servo;
static const char* serial = "20-1234";

static void push_error(unsigned code) {
    pthread_mutex_lock(&lock);
    if (error_count < 16) errors[error_count++] = code;
    if (error_count > most_errors) most_errors = error_count;
    pthread_mutex_unlock(&lock);
}

/* ---- the test's side ---- */
void fake_reset(void) {
    pthread_mutex_lock(&lock);
    const double unit[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    memcpy(transform, unit, sizeof unit);
    memset(force, 0, sizeof force);
    buttons = is_lost = hangs = is_nan = force_on = forces_outside = error_count = needs_update = 0;
    is_calibrated = 1;
    pthread_mutex_unlock(&lock);
}
/* In mm, and a rotation by rows. */
void fake_place(const double* p, const double* rows) {
    pthread_mutex_lock(&lock);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) transform[4 * column + row] = rows[3 * row + column];
    memcpy(transform + 12, p, 3 * sizeof *p);
    pthread_mutex_unlock(&lock);
}
void fake_buttons(unsigned mask) { buttons = (int)mask; }
void fake_hang(int on) { hangs = on; }
void fake_lose(int on) {
    pthread_mutex_lock(&lock);
    is_lost = on;
    memset(force, 0, sizeof force); /* a device without current */
    pthread_mutex_unlock(&lock);
}
void fake_nan(int on) { is_nan = on; }
void fake_calibrate(int on) { is_calibrated = on; }
void fake_needs_update(void) { needs_update = 1; }
void fake_warm(void) { push_error(0x0200); }
void fake_given(double* six) {
    pthread_mutex_lock(&lock);
    memcpy(six, force, sizeof force);
    pthread_mutex_unlock(&lock);
}
int fake_force_on(void) { return force_on; }
int fake_is_open(void) { return runs; }
int fake_forces_before_enable(void) { return forces_outside; }
int fake_errors_left(void) { return error_count; }

/* ---- the vendor's side ---- */
static double seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}
static void rest(void) {
    const struct timespec t = {0, 1000000};
    nanosleep(&t, NULL);
}
static void* run(void* none) {
    (void)none;
    /* Asks for the user's language; where numbers have no point, it misreads its own settings. */
    setlocale(LC_ALL, "");
    if (localeconv()->decimal_point[0] != '.') push_error(0x0303);
    while (!__atomic_load_n(&must_stop, __ATOMIC_SEQ_CST)) {
        rest();
        if (callback && callback(data) == 0) callback = NULL;
    }
    return NULL;
}
unsigned hdInitDevice(const char* name) {
    if (is_lost || !name || strcmp(name, "Default Device") != 0) {
        push_error(0x0302);
        return 0xFFFFFFFFu;
    }
    return 0;
}
void hdDisableDevice(unsigned device) { (void)device; }
void hdMakeCurrentDevice(unsigned device) { (void)device; }
void hdBeginFrame(unsigned device) {
    (void)device;
    while (__atomic_load_n(&hangs, __ATOMIC_SEQ_CST)) rest();
    in_frame = 1;
    memset(next_force, 0, sizeof next_force); /* who sets none gives none */
    if (is_lost) {
        push_error(0x0204);
        push_error(0x0302);
    }
}
void hdEndFrame(unsigned device) {
    (void)device;
    in_frame = 0;
    pthread_mutex_lock(&lock);
    if (!is_lost) memcpy(force, next_force, sizeof force);
    pthread_mutex_unlock(&lock);
}
Error hdGetError(void) {
    Error error = {0, 0, 0};
    pthread_mutex_lock(&lock);
    if (error_count > 0) error.code = errors[--error_count];
    pthread_mutex_unlock(&lock);
    return error;
}
const char* hdGetErrorString(unsigned code) { return code == 0x0302 ? "Communication Error" : "Error"; }
void hdEnable(unsigned what) {
    if (what == 0x4000) force_on = 1;
}
void hdDisable(unsigned what) {
    if (what == 0x4000) force_on = 0;
}
void hdGetDoublev(unsigned what, double* values) {
    if (what == 0x2602) *values = 0.5;
    else if (what == 0x2603) *values = 3.3;
    else if (what == 0x2505) *values = 1.5;
    else if (what == 0x2052 && in_frame) {
        pthread_mutex_lock(&lock);
        memcpy(values, transform, sizeof transform);
        pthread_mutex_unlock(&lock);
        if (is_nan) values[12] = NAN;
        if (getenv("FAKE_DEVICE_MOVES")) values[13] = -20.0 * (1.0 - cos(6.283185307179586 * seconds()));
    } else push_error(0x0100);
}
void hdSetDoublev(unsigned what, const double* values) {
    if (!in_frame) ++forces_outside;
    if (!force_on && (values[0] != 0.0 || values[1] != 0.0 || values[2] != 0.0)) ++forces_outside;
    if (what == 0x2700) memcpy(next_force, values, 3 * sizeof *values);
    else if (what == 0x2701) memcpy(next_force + 3, values, 3 * sizeof *values);
}
void hdGetIntegerv(unsigned what, int* values) {
    if (what == 0x2000) *values = buttons;
    else if (what == 0x2554) *values = 3;
    else if (what == 0x2555) *values = 4;
}
const char* hdGetString(unsigned what) {
    return what == 0x2501 ? "Touch" : what == 0x2504 ? serial : what == 0x2502 ? "2023.11.15" : "";
}
unsigned hdCheckCalibration(void) { return needs_update ? 0x5001 : is_calibrated ? 0x5000 : 0x5002; }
void hdUpdateCalibration(unsigned style) {
    if (style == 4) needs_update = 0;
}
unsigned long hdScheduleAsynchronous(unsigned (*function)(void*), void* given, unsigned short priority) {
    (void)priority;
    data = given;
    callback = function;
    return 7;
}
void hdUnschedule(unsigned long handle) {
    (void)handle;
    callback = NULL;
}
void hdStartScheduler(void) {
    must_stop = 0;
    runs = 1;
    pthread_create(&servo, NULL, run, NULL);
}
void hdStopScheduler(void) {
    if (!runs) return;
    __atomic_store_n(&must_stop, 1, __ATOMIC_SEQ_CST);
    pthread_join(servo, NULL);
    runs = 0;
    memset(force, 0, sizeof force); /* a servo loop that stands gives no force */
}
void hdSetSchedulerRate(unsigned long hertz) { (void)hertz; }
