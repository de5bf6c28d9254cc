/* A host in C, for Linux and Windows: loads an FMU's library, leads instances through their life, right and wrong, then makes a run
 * of a heaving ship and prints its outputs.
 *
 *     drive LIBRARY GUID RESOURCES SECONDS Z VZ AZ OUTPUT...
 *
 * The last ones are value references: the inputs ship.z, ship.vz, ship.az, and the outputs to print, one line a communication step.
 * Exit status 0 only if every call answered as FMI 2.0 has it. For valgrind, and for Windows' libraries under wine. */

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#endif

typedef void *Component;
typedef void (*Logger)(void *, const char *, int, const char *, const char *, ...);
typedef struct {
    Logger logger;
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, int);
    void *environment;
} Callbacks;

enum { FMI_OK, FMI_WARNING, FMI_DISCARD, FMI_ERROR };

static Component (*Instantiate)(const char *, int, const char *, const char *, const Callbacks *, int, int);
static void (*FreeInstance)(Component);
static int (*SetupExperiment)(Component, int, double, double, int, double);
static int (*EnterInitializationMode)(Component);
static int (*ExitInitializationMode)(Component);
static int (*Terminate)(Component);
static int (*Reset)(Component);
static int (*GetReal)(Component, const unsigned *, size_t, double *);
static int (*SetReal)(Component, const unsigned *, size_t, const double *);
static int (*DoStep)(Component, double, double, int);
static int (*GetFMUstate)(Component, void **);
static int (*SetFMUstate)(Component, void *);
static int (*FreeFMUstate)(Component, void **);
static int (*SerializedFMUstateSize)(Component, void *, size_t *);
static int (*SerializeFMUstate)(Component, void *, char *, size_t);
static int (*DeSerializeFMUstate)(Component, const char *, size_t, void **);

static int lines;

/* As most hosts do: the message is a printf format. */
static void log_message(void *environment, const char *name, int status, const char *category, const char *message, ...)
{
    char text[4096];
    va_list arguments;
    va_start(arguments, message);
    vsnprintf(text, sizeof text, message, arguments);
    va_end(arguments);
    if (environment != &lines || strcmp(name, "rope") || !strlen(category) || !strlen(text) || status > FMI_ERROR)
        exit(3);
    lines++;
}

static void expect(int good, int line)
{
    if (!good) {
        fprintf(stderr, "drive.c:%d: not as expected\n", line);
        exit(1);
    }
}
#define EXPECT(good) expect((good), __LINE__)

static void *symbol(void *library, const char *name)
{
    void *found;
#ifdef _WIN32
    found = (void *)GetProcAddress((HMODULE)library, name);
#else
    found = dlsym(library, name);
#endif
    EXPECT(found != NULL);
    return found;
}

static void *load(const char *path)
{
    void *library;
#ifdef _WIN32
    library = (void *)LoadLibraryA(path);
#else
    library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
#endif
    EXPECT(library != NULL);
#define TAKE(name) *(void **)&name = symbol(library, "fmi2" #name)
    TAKE(Instantiate), TAKE(FreeInstance), TAKE(SetupExperiment), TAKE(EnterInitializationMode), TAKE(ExitInitializationMode);
    TAKE(Terminate), TAKE(Reset), TAKE(GetReal), TAKE(SetReal), TAKE(DoStep), TAKE(GetFMUstate), TAKE(SetFMUstate), TAKE(FreeFMUstate);
    TAKE(SerializedFMUstateSize), TAKE(SerializeFMUstate), TAKE(DeSerializeFMUstate);
    return library;
}

static void unload(void *library)
{
#ifdef _WIN32
    FreeLibrary((HMODULE)library);
#else
    dlclose(library);
#endif
}

/* The callback struct is freed at once, as it is in hosts that keep it on the stack. */
static Component instantiate(const char *guid, const char *resources)
{
    Callbacks *callbacks = calloc(1, sizeof *callbacks);
    Component made;
    callbacks->logger = log_message;
    callbacks->environment = &lines;
    made = Instantiate("rope", 1, guid, resources, callbacks, 0, 1);
    memset(callbacks, 0xff, sizeof *callbacks);
    free(callbacks);
    return made;
}

static void start(Component c)
{
    EXPECT(SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0) == FMI_OK);
    EXPECT(EnterInitializationMode(c) == FMI_OK);
    EXPECT(ExitInitializationMode(c) == FMI_OK);
}

static void sail(Component c, const unsigned *inputs, double t, double h)
{
    const double omega = 3.0, heave = 0.01;
    double values[3];
    values[0] = heave * sin(omega * t);
    values[1] = heave * omega * cos(omega * t);
    values[2] = -omega * omega * values[0];
    EXPECT(SetReal(c, inputs, 3, values) == FMI_OK);
    EXPECT(DoStep(c, t, h, 1) <= FMI_WARNING);
}

/* Every kind of call, the refused ones too. */
static void life(const char *guid, const char *resources, const unsigned *inputs, const unsigned *outputs, size_t count)
{
    double *before = calloc(count, sizeof *before), *after = calloc(count, sizeof *after);
    double nan = strtod("nan", NULL);
    void *state = NULL;
    char *bytes;
    size_t size = 0;
    Component c;

    EXPECT(instantiate("{no}", resources) == NULL);
    EXPECT(instantiate(guid, "file:///no/such/folder") == NULL);
    c = instantiate(guid, resources);
    EXPECT(c != NULL);
    EXPECT(DoStep(c, 0.0, 0.02, 1) == FMI_ERROR);
    start(c);
    sail(c, inputs, 0.0, 0.02);
    EXPECT(DoStep(c, 0.02, nan, 1) == FMI_ERROR);
    EXPECT(DoStep(c, 7.0, 0.02, 1) == FMI_ERROR);
    EXPECT(SetReal(c, inputs, 1, &nan) == FMI_ERROR);
    EXPECT(SetReal(c, NULL, 1, &nan) == FMI_ERROR);

    EXPECT(GetFMUstate(c, &state) == FMI_OK);
    EXPECT(SerializedFMUstateSize(c, state, &size) == FMI_OK);
    bytes = malloc(size);
    EXPECT(SerializeFMUstate(c, state, bytes, size) == FMI_OK);
    sail(c, inputs, 0.02, 0.02);
    EXPECT(GetReal(c, outputs, count, before) == FMI_OK);
    EXPECT(FreeFMUstate(c, &state) == FMI_OK && state == NULL);
    EXPECT(DeSerializeFMUstate(c, bytes, size / 2, &state) == FMI_ERROR && state == NULL);
    bytes[size / 2] ^= 1;
    EXPECT(DeSerializeFMUstate(c, bytes, size, &state) == FMI_ERROR && state == NULL);
    bytes[size / 2] ^= 1;
    EXPECT(DeSerializeFMUstate(c, bytes, size, &state) == FMI_OK);
    EXPECT(SetFMUstate(c, state) == FMI_OK);
    sail(c, inputs, 0.02, 0.02);
    EXPECT(GetReal(c, outputs, count, after) == FMI_OK);
    EXPECT(memcmp(before, after, count * sizeof *before) == 0);
    EXPECT(FreeFMUstate(c, &state) == FMI_OK);
    free(bytes);

    EXPECT(Terminate(c) == FMI_OK);
    EXPECT(Reset(c) == FMI_OK);
    start(c);
    sail(c, inputs, 0.0, 0.02);
    FreeInstance(c);
    FreeInstance(NULL);
    free(before);
    free(after);
}

int main(int count, char **arguments)
{
    unsigned inputs[3], *outputs;
    size_t i, outs;
    double *values, seconds, h = 0.02;
    void *library;
    Component c;
    int k;

    if (count < 9)
        return 2;
    outs = (size_t)count - 8;
    outputs = calloc(outs, sizeof *outputs);
    values = calloc(outs, sizeof *values);
    for (i = 0; i < 3; i++)
        inputs[i] = (unsigned)strtoul(arguments[5 + i], NULL, 10);
    for (i = 0; i < outs; i++)
        outputs[i] = (unsigned)strtoul(arguments[8 + i], NULL, 10);
    seconds = atof(arguments[4]);

    /* Twice: the library is unloaded and loaded again in between. */
    for (k = 0; k < 2; k++) {
        library = load(arguments[1]);
        life(arguments[2], arguments[3], inputs, outputs, outs);
        unload(library);
    }
    library = load(arguments[1]);
    c = instantiate(arguments[2], arguments[3]);
    EXPECT(c != NULL);
    start(c);
    for (k = 0; k * h < seconds - 0.5 * h; k++) {
        sail(c, inputs, k * h, h);
        EXPECT(GetReal(c, outputs, outs, values) == FMI_OK);
        for (i = 0; i < outs; i++)
            printf("%.17g%c", values[i], i + 1 < outs ? ' ' : '\n');
    }
    FreeInstance(c);
    unload(library);
    free(outputs);
    free(values);
    EXPECT(lines > 0);
    return 0;
}
