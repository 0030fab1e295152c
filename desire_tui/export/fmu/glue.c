/* The functions of FMI 3.0 around a run that Desire has exported to C (model.c, included here).
 *
 * All numbers of the run are static: there is one instance in a process, as modelDescription.xml says.
 * A value reference is a place in v[]; from DERIVATIVES on, the number of a state's derivative.
 */
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#define DESIRE_LIBRARY
#include "model.c"

typedef void *fmi3Instance;
typedef uint32_t fmi3ValueReference;
typedef bool fmi3Boolean;
typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef void (*fmi3LogMessage)(void *, fmi3Status, const char *, const char *);

#if defined _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

#define DERIVATIVES 1000000000u
#define COUNT (sizeof v / sizeof v[0])

static double first[COUNT];
static int has_first, is_instance, is_stale;
static fmi3LogMessage log_message;
static void *environment;

static fmi3Status fail(const char *text)
{
    if (log_message)
        log_message(environment, fmi3Error, "logStatusError", text);
    return fmi3Error;
}

static void begin(void)
{
    if (!has_first) {
        memcpy(first, v, sizeof v);
        has_first = 1;
    }
    memcpy(v, first, sizeof v);
    point = 0;
    fired = -1;
    reset_run();
    is_stale = 1;
}

/* Defined variables and derivatives from states, parameters and t. */
static void refresh(void)
{
    if (is_stale)
        compute_pass();
    is_stale = 0;
}

EXPORT const char *fmi3GetVersion(void)
{
    return "3.0";
}

EXPORT fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n, const char *const names[])
{
    (void)c, (void)on, (void)n, (void)names;
    return fmi3OK;
}

static fmi3Instance instantiate(const char *token, void *env, fmi3LogMessage message)
{
    log_message = message;
    environment = env;
    if (is_instance || !token || strcmp(token, TOKEN) != 0) {
        fail(is_instance ? "there is an instance already" : "the instantiation token is another model's");
        return NULL;
    }
    is_instance = 1;
    begin();
    return &is_instance;
}

EXPORT fmi3Instance fmi3InstantiateModelExchange(
    const char *name, const char *token, const char *path, fmi3Boolean visible, fmi3Boolean on, void *env,
    fmi3LogMessage message)
{
    (void)name, (void)path, (void)visible, (void)on;
    return instantiate(token, env, message);
}

EXPORT fmi3Instance fmi3InstantiateCoSimulation(
    const char *name, const char *token, const char *path, fmi3Boolean visible, fmi3Boolean on,
    fmi3Boolean event_mode, fmi3Boolean early, const fmi3ValueReference required[], size_t n, void *env,
    fmi3LogMessage message, void *update)
{
    (void)name, (void)path, (void)visible, (void)on, (void)event_mode, (void)early, (void)required, (void)n;
    (void)update;
    return instantiate(token, env, message);
}

EXPORT fmi3Instance fmi3InstantiateScheduledExecution(
    const char *name, const char *token, const char *path, fmi3Boolean visible, fmi3Boolean on, void *env,
    fmi3LogMessage message, void *update, void *lock, void *unlock)
{
    (void)name, (void)token, (void)path, (void)visible, (void)on, (void)env, (void)message, (void)update;
    (void)lock, (void)unlock;
    return NULL;
}

EXPORT void fmi3FreeInstance(fmi3Instance c)
{
    if (c)
        is_instance = 0;
}

EXPORT fmi3Status fmi3EnterInitializationMode(
    fmi3Instance c, fmi3Boolean has_tolerance, double tolerance, double start, fmi3Boolean has_stop, double stop)
{
    (void)c, (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
    q_t = start;
    is_stale = 1;
    return fmi3OK;
}

EXPORT fmi3Status fmi3ExitInitializationMode(fmi3Instance c)
{
    (void)c;
    begin_point();
    is_stale = 0;
    return fmi3OK;
}

EXPORT fmi3Status fmi3Reset(fmi3Instance c)
{
    (void)c;
    begin();
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n, double values[], size_t m)
{
    (void)c, (void)m;
    refresh();
    for (size_t i = 0; i < n; i++) {
        if (r[i] >= DERIVATIVES && r[i] - DERIVATIVES < ORDER)
            values[i] = derivative(r[i] - DERIVATIVES);
        else if (r[i] < COUNT)
            values[i] = v[r[i]];
        else
            return fail("there is no variable of this value reference");
    }
    return fmi3OK;
}

EXPORT fmi3Status fmi3SetFloat64(
    fmi3Instance c, const fmi3ValueReference r[], size_t n, const double values[], size_t m)
{
    (void)c, (void)m;
    for (size_t i = 0; i < n; i++) {
        if (r[i] >= COUNT)
            return fail("there is no variable of this value reference");
        v[r[i]] = values[i];
    }
    is_stale = 1;
    return fmi3OK;
}

EXPORT fmi3Status fmi3SetTime(fmi3Instance c, double time)
{
    (void)c;
    q_t = time;
    is_stale = 1;
    return fmi3OK;
}

EXPORT fmi3Status fmi3SetContinuousStates(fmi3Instance c, const double x[], size_t n)
{
    (void)c;
    for (size_t i = 0; i < n && i < ORDER; i++)
        *state(i) = x[i];
    is_stale = 1;
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetContinuousStates(fmi3Instance c, double x[], size_t n)
{
    (void)c;
    for (size_t i = 0; i < n && i < ORDER; i++)
        x[i] = *state(i);
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, double dx[], size_t n)
{
    (void)c;
    refresh();
    for (size_t i = 0; i < n && i < ORDER; i++)
        dx[i] = derivative(i);
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, double x[], size_t n)
{
    (void)c;
    for (size_t i = 0; i < n; i++)
        x[i] = 1.0;
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t *n)
{
    (void)c;
    *n = ORDER;
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t *n)
{
    (void)c;
    *n = 0;
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetEventIndicators(fmi3Instance c, double z[], size_t n)
{
    (void)c, (void)z, (void)n;
    return fmi3OK;
}

EXPORT fmi3Status fmi3CompletedIntegratorStep(
    fmi3Instance c, fmi3Boolean no_way_back, fmi3Boolean *enter_event, fmi3Boolean *terminate)
{
    (void)c, (void)no_way_back;
    *enter_event = *terminate = false;
    return fmi3OK;
}

EXPORT fmi3Status fmi3UpdateDiscreteStates(
    fmi3Instance c, fmi3Boolean *again, fmi3Boolean *terminate, fmi3Boolean *nominals, fmi3Boolean *values,
    fmi3Boolean *has_next, double *next)
{
    (void)c, (void)next;
    *again = *terminate = *nominals = *values = *has_next = false;
    return fmi3OK;
}

EXPORT fmi3Status fmi3DoStep(
    fmi3Instance c, double time, double length, fmi3Boolean no_way_back, fmi3Boolean *event, fmi3Boolean *terminate,
    fmi3Boolean *early, double *last)
{
    int ended;
    (void)c, (void)no_way_back;
    *event = *early = *terminate = false;
    q_t = time;
    ended = run_to(time + length);
    is_stale = 0;
    *last = q_t;
    if (ended < 0)
        return fail("a state is no number, or steps became too small");
    *terminate = ended > 0; /* a `term` statement */
    *early = q_t < time + length;
    return fmi3OK;
}

#define DONE(name) \
    EXPORT fmi3Status name(fmi3Instance c) \
    { \
        (void)c; \
        return fmi3OK; \
    }

DONE(fmi3Terminate)
DONE(fmi3EnterEventMode)
DONE(fmi3EnterContinuousTimeMode)
DONE(fmi3EnterStepMode)
DONE(fmi3EnterConfigurationMode)
DONE(fmi3ExitConfigurationMode)
DONE(fmi3EvaluateDiscreteStates)

/* What the description does not offer; importers load these all the same. */
#define MISSING(name) \
    EXPORT fmi3Status name(void) \
    { \
        return fail(#name ": the model has nothing of this kind"); \
    }

MISSING(fmi3GetFloat32)
MISSING(fmi3SetFloat32)
MISSING(fmi3GetInt8)
MISSING(fmi3SetInt8)
MISSING(fmi3GetUInt8)
MISSING(fmi3SetUInt8)
MISSING(fmi3GetInt16)
MISSING(fmi3SetInt16)
MISSING(fmi3GetUInt16)
MISSING(fmi3SetUInt16)
MISSING(fmi3GetInt32)
MISSING(fmi3SetInt32)
MISSING(fmi3GetUInt32)
MISSING(fmi3SetUInt32)
MISSING(fmi3GetInt64)
MISSING(fmi3SetInt64)
MISSING(fmi3GetUInt64)
MISSING(fmi3SetUInt64)
MISSING(fmi3GetBoolean)
MISSING(fmi3SetBoolean)
MISSING(fmi3GetString)
MISSING(fmi3SetString)
MISSING(fmi3GetBinary)
MISSING(fmi3SetBinary)
MISSING(fmi3GetClock)
MISSING(fmi3SetClock)
MISSING(fmi3GetIntervalDecimal)
MISSING(fmi3GetIntervalFraction)
MISSING(fmi3GetShiftDecimal)
MISSING(fmi3GetShiftFraction)
MISSING(fmi3SetIntervalDecimal)
MISSING(fmi3SetIntervalFraction)
MISSING(fmi3SetShiftDecimal)
MISSING(fmi3SetShiftFraction)
MISSING(fmi3GetNumberOfVariableDependencies)
MISSING(fmi3GetVariableDependencies)
MISSING(fmi3GetFMUState)
MISSING(fmi3SetFMUState)
MISSING(fmi3FreeFMUState)
MISSING(fmi3SerializedFMUStateSize)
MISSING(fmi3SerializeFMUState)
MISSING(fmi3DeserializeFMUState)
MISSING(fmi3GetDirectionalDerivative)
MISSING(fmi3GetAdjointDerivative)
MISSING(fmi3GetOutputDerivatives)
MISSING(fmi3ActivateModelPartition)
