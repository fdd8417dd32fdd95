// Names that the C library declares outside of any namespace, in the headers that C++'s own bring along: functions,
// types and variables of glibc, as `gcc -aux-info` lists them, and what else the compiler refuses. A namespace of one
// of these names does not compile.
#pragma once

#include <string_view>

namespace hysteron {

/// Separated by blanks and line ends. Variants that nobody names a block after (acosf32x, strtol_l) are left out.
inline constexpr std::string_view c_library_names = R"(
    a64l abort abs accept accept4 access acct acos acosf acosh acoshf acoshl acosl adjtime alarm aligned_alloc alloca
    arc4random arc4random_buf arc4random_uniform asctime asctime_r asin asinf asinh asinhf asinhl asinl asprintf
    at_quick_exit atan atan2 atan2f atan2l atanf atanh atanhf atanhl atanl atexit atof atoi atol atoll basename bcmp
    bcopy bind blkcnt64_t blkcnt_t blksize_t brk bsearch btowc bzero c16rtomb c32rtomb c8rtomb caddr_t calloc
    canonicalize canonicalize_file_name canonicalizef canonicalizel cbrt cbrtf cbrtl ceil ceilf ceill chdir chmod chown
    chroot clearenv clearerr clearerr_unlocked clock clock_adjtime clock_getcpuclockid clock_getres clock_gettime
    clock_nanosleep clock_settime clock_t clockid_t clone close close_range closefrom cmsghdr comparison_fn_t confstr
    connect cookie_close_function_t cookie_io_functions_t cookie_read_function_t cookie_seek_function_t
    cookie_write_function_t copy_file_range copysign copysignf copysignl cos cosf cosh coshf coshl cosl cpu_set_t creat
    creat64 crypt ctermid ctime ctime_r cuserid daddl daddr_t daemon daylight ddivl dev_t dfmal difftime div div_t dmull
    double_t dprintf drand48 drand48_data drand48_r drem dremf dreml dsqrtl dsubl dup dup2 dup3 duplocale dysize eaccess
    ecvt ecvt_r endusershell environ erand48 erand48_r erf erfc erfcf erfcl erff erfl error_t euidaccess execl execle
    execlp execv execve execveat execvp execvpe exit exp exp10 exp10f exp10l exp2 exp2f exp2l expf expl explicit_bzero
    expm1 expm1f expm1l fabs fabsf fabsl faccessat fadd faddl fallocate fallocate64 fchdir fchmod fchmodat fchown
    fchownat fclose fcloseall fcntl fcntl64 fcvt fcvt_r fd_mask fd_set fdatasync fdim fdimf fdiml fdiv fdivl fdopen
    feclearexcept fedisableexcept feenableexcept fegetenv fegetexcept fegetexceptflag fegetmode fegetround feholdexcept
    femode_t fenv_t feof feof_unlocked feraiseexcept ferror ferror_unlocked fesetenv fesetexcept fesetexceptflag
    fesetmode fesetround fetestexcept fetestexceptflag feupdateenv fexcept_t fexecve fflush fflush_unlocked ffma ffmal
    ffs ffsl ffsll fgetc fgetc_unlocked fgetpos fgetpos64 fgets fgets_unlocked fgetwc fgetwc_unlocked fgetws
    fgetws_unlocked fileno fileno_unlocked finite finitef finitel float_t flock flockfile floor floorf floorl fma fmaf
    fmal fmax fmaxf fmaximum fmaximum_mag fmaximum_mag_num fmaximum_mag_numf fmaximum_mag_numl fmaximum_magf
    fmaximum_magl fmaximum_num fmaximum_numf fmaximum_numl fmaximumf fmaximuml fmaxl fmaxmag fmaxmagf fmaxmagl fmemopen
    fmin fminf fminimum fminimum_mag fminimum_mag_num fminimum_mag_numf fminimum_mag_numl fminimum_magf fminimum_magl
    fminimum_num fminimum_numf fminimum_numl fminimumf fminimuml fminl fminmag fminmagf fminmagl fmod fmodf fmodl fmul
    fmull fopen fopen64 fopencookie fork fpathconf fpos64_t fpos_t fpregset_t fprintf fputc fputc_unlocked fputs
    fputs_unlocked fputwc fputwc_unlocked fputws fputws_unlocked fread fread_unlocked free freelocale freopen freopen64
    frexp frexpf frexpl fromfp fromfpf fromfpl fromfpx fromfpxf fromfpxl fsblkcnt64_t fsblkcnt_t fscanf fseek fseeko
    fseeko64 fsetpos fsetpos64 fsfilcnt64_t fsfilcnt_t fsid_t fsqrt fsqrtl fstat fstat64 fstatat fstatat64 fsub fsubl
    fsync ftell ftello ftello64 ftruncate ftruncate64 ftrylockfile funlockfile futimens futimes futimesat fwide fwprintf
    fwrite fwrite_unlocked fwscanf gamma gammaf gammal gcvt get_current_dir_name getc getc_unlocked getchar
    getchar_unlocked getcpu getcwd getdate getdate_err getdate_r getdelim getdomainname getdtablesize getegid getentropy
    getenv geteuid getgid getgroups gethostid gethostname getitimer getline getloadavg getlogin getlogin_r getopt
    getpagesize getpass getpayload getpayloadf getpayloadl getpeername getpgid getpgrp getpid getppid getpt getresgid
    getresuid getsid getsockname getsockopt getsubopt gettid gettimeofday getuid getumask getusershell getw getwc
    getwc_unlocked getwchar getwchar_unlocked getwd gid_t gmtime gmtime_r grantpt greg_t gregset_t group_member gsignal
    hypot hypotf hypotl id_t ilogb ilogbf ilogbl imaxabs imaxdiv imaxdiv_t index initstate initstate_r ino64_t ino_t
    int16_t int32_t int64_t int8_t int_fast16_t int_fast32_t int_fast64_t int_fast8_t int_least16_t int_least32_t
    int_least64_t int_least8_t intmax_t intptr_t iovec isalnum isalpha isascii isatty isblank iscanonical iscntrl
    isctype isdigit iseqsig isfdtype isgraph isinf isinff isinfl islower isnan isnanf isnanl isprint ispunct issignaling
    isspace isupper iswalnum iswalpha iswblank iswcntrl iswctype iswdigit iswgraph iswlower iswprint iswpunct iswspace
    iswupper iswxdigit isxdigit iszero itimerspec itimerval j0 j0f j0l j1 j1f j1l jmp_buf jn jnf jnl jrand48 jrand48_r
    key_t kill killpg l64a labs lchmod lchown lcong48 lcong48_r lconv ldexp ldexpf ldexpl ldiv ldiv_t lgamma lgamma_r
    lgammaf lgammaf_r lgammal lgammal_r linger link linkat linux listen llabs lldiv lldiv_t llogb llogbf llogbl llrint
    llrintf llrintl llround llroundf llroundl locale_t localeconv localtime localtime_r lockf loff_t log log10 log10f
    log10l log1p log1pf log1pl log2 log2f log2l logb logbf logbl logf logl longjmp lrand48 lrand48_r lrint lrintf lrintl
    lround lroundf lroundl lseek lseek64 lstat lstat64 lutimes madvise malloc max_align_t mblen mbrlen mbrtoc16 mbrtoc32
    mbrtoc8 mbrtowc mbsinit mbsnrtowcs mbsrtowcs mbstate_t mbstowcs mbtowc mcontext_t memccpy memchr memcmp memcpy
    memfd_create memfrob memmem memmove mempcpy memrchr memset mincore mkdir mkdirat mkdtemp mkfifo mkfifoat mknod
    mknodat mkostemp mkostemp64 mkostemps mkostemps64 mkstemp mkstemp64 mkstemps mkstemps64 mktemp mktime mlock mlock2
    mlockall mmap mmap64 mode_t modf modff modfl mprotect mrand48 mrand48_r mremap msghdr msync munlock munlockall
    munmap nan nanf nanl nanosleep nearbyint nearbyintf nearbyintl newlocale nextafter nextafterf nextafterl nextdown
    nextdownf nextdownl nexttoward nexttowardf nexttowardl nextup nextupf nextupl nice nlink_t nrand48 nrand48_r
    nullptr_t obstack obstack_printf obstack_vprintf off64_t off_t on_exit open open64 open_memstream open_wmemstream
    openat openat64 optarg opterr optind option optopt pathconf pause pclose perror pid_t pipe pipe2 pkey_alloc
    pkey_free pkey_get pkey_mprotect pkey_set poll pollfd popen posix_fadvise posix_fadvise64 posix_fallocate
    posix_fallocate64 posix_madvise posix_memalign posix_openpt pow powf powl ppoll pread pread64 printf process_madvise
    process_mrelease profil program_invocation_name program_invocation_short_name pselect psiginfo psignal
    pthread_atfork pthread_attr_destroy pthread_attr_getaffinity_np pthread_attr_getdetachstate
    pthread_attr_getguardsize pthread_attr_getinheritsched pthread_attr_getschedparam pthread_attr_getschedpolicy
    pthread_attr_getscope pthread_attr_getsigmask_np pthread_attr_getstack pthread_attr_getstackaddr
    pthread_attr_getstacksize pthread_attr_init pthread_attr_setaffinity_np pthread_attr_setdetachstate
    pthread_attr_setguardsize pthread_attr_setinheritsched pthread_attr_setschedparam pthread_attr_setschedpolicy
    pthread_attr_setscope pthread_attr_setsigmask_np pthread_attr_setstack pthread_attr_setstackaddr
    pthread_attr_setstacksize pthread_attr_t pthread_barrier_destroy pthread_barrier_init pthread_barrier_t
    pthread_barrier_wait pthread_barrierattr_destroy pthread_barrierattr_getpshared pthread_barrierattr_init
    pthread_barrierattr_setpshared pthread_barrierattr_t pthread_cancel pthread_clockjoin_np pthread_cond_broadcast
    pthread_cond_clockwait pthread_cond_destroy pthread_cond_init pthread_cond_signal pthread_cond_t
    pthread_cond_timedwait pthread_cond_wait pthread_condattr_destroy pthread_condattr_getclock
    pthread_condattr_getpshared pthread_condattr_init pthread_condattr_setclock pthread_condattr_setpshared
    pthread_condattr_t pthread_create pthread_detach pthread_equal pthread_exit pthread_getaffinity_np
    pthread_getattr_default_np pthread_getattr_np pthread_getconcurrency pthread_getcpuclockid pthread_getname_np
    pthread_getschedparam pthread_getspecific pthread_join pthread_key_create pthread_key_delete pthread_key_t
    pthread_kill pthread_mutex_clocklock pthread_mutex_consistent pthread_mutex_consistent_np pthread_mutex_destroy
    pthread_mutex_getprioceiling pthread_mutex_init pthread_mutex_lock pthread_mutex_setprioceiling pthread_mutex_t
    pthread_mutex_timedlock pthread_mutex_trylock pthread_mutex_unlock pthread_mutexattr_destroy
    pthread_mutexattr_getprioceiling pthread_mutexattr_getprotocol pthread_mutexattr_getpshared
    pthread_mutexattr_getrobust pthread_mutexattr_getrobust_np pthread_mutexattr_gettype pthread_mutexattr_init
    pthread_mutexattr_setprioceiling pthread_mutexattr_setprotocol pthread_mutexattr_setpshared
    pthread_mutexattr_setrobust pthread_mutexattr_setrobust_np pthread_mutexattr_settype pthread_mutexattr_t
    pthread_once pthread_once_t pthread_rwlock_clockrdlock pthread_rwlock_clockwrlock pthread_rwlock_destroy
    pthread_rwlock_init pthread_rwlock_rdlock pthread_rwlock_t pthread_rwlock_timedrdlock pthread_rwlock_timedwrlock
    pthread_rwlock_tryrdlock pthread_rwlock_trywrlock pthread_rwlock_unlock pthread_rwlock_wrlock
    pthread_rwlockattr_destroy pthread_rwlockattr_getkind_np pthread_rwlockattr_getpshared pthread_rwlockattr_init
    pthread_rwlockattr_setkind_np pthread_rwlockattr_setpshared pthread_rwlockattr_t pthread_self pthread_setaffinity_np
    pthread_setattr_default_np pthread_setcancelstate pthread_setcanceltype pthread_setconcurrency pthread_setname_np
    pthread_setschedparam pthread_setschedprio pthread_setspecific pthread_sigmask pthread_sigqueue pthread_spin_destroy
    pthread_spin_init pthread_spin_lock pthread_spin_trylock pthread_spin_unlock pthread_spinlock_t pthread_t
    pthread_testcancel pthread_timedjoin_np pthread_tryjoin_np pthread_yield ptrdiff_t ptsname ptsname_r putc
    putc_unlocked putchar putchar_unlocked putenv puts putw putwc putwc_unlocked putwchar putwchar_unlocked pwrite
    pwrite64 qecvt qecvt_r qfcvt qfcvt_r qgcvt qsort qsort_r quad_t quick_exit raise rand rand_r random random_data
    random_r rawmemchr read readahead readlink readlinkat realloc reallocarray realpath recv recvfrom recvmmsg recvmsg
    register_t remainder remainderf remainderl remove remquo remquof remquol rename renameat renameat2 revoke rewind
    rindex rint rintf rintl rmdir round roundeven roundevenf roundevenl roundf roundl rpmatch sa_handler sa_sigaction
    sbrk scalb scalbf scalbl scalbln scalblnf scalblnl scalbn scalbnf scalbnl scanf sched_get_priority_max
    sched_get_priority_min sched_getaffinity sched_getcpu sched_getparam sched_getscheduler sched_param
    sched_rr_get_interval sched_setaffinity sched_setparam sched_setscheduler sched_yield secure_getenv seed48 seed48_r
    select sem_clockwait sem_close sem_destroy sem_getvalue sem_init sem_open sem_post sem_t sem_timedwait sem_trywait
    sem_unlink sem_wait send sendmmsg sendmsg sendto setbuf setbuffer setdomainname setegid setenv seteuid setgid
    sethostid sethostname setitimer setjmp setlinebuf setlocale setlogin setns setpayload setpayloadf setpayloadl
    setpayloadsig setpayloadsigf setpayloadsigl setpgid setpgrp setregid setresgid setresuid setreuid setsid setsockopt
    setstate setstate_r settimeofday setuid setusershell setvbuf shm_open shm_unlink shutdown si_addr si_addr_lsb
    si_band si_fd si_overrun si_pid si_status si_stime si_uid si_utime sig_atomic_t sig_t sigabbrev_np sigaction
    sigaddset sigaltstack sigandset sigblock sigcontext sigdelset sigdescr_np sigemptyset sigevent sigevent_t sigfillset
    siggetmask sighandler_t sighold sigignore siginfo_t siginterrupt sigisemptyset sigismember siglongjmp signal signgam
    significand significandf significandl sigorset sigpause sigpending sigprocmask sigqueue sigrelse sigreturn sigset
    sigset_t sigsetmask sigstack sigsuspend sigtimedwait sigval sigval_t sigwait sigwaitinfo sin sincos sincosf sincosl
    sinf sinh sinhf sinhl sinl size_t sleep snprintf sockaddr sockatmark socket socketpair socklen_t splice sprintf sqrt
    sqrtf sqrtl srand srand48 srand48_r srandom srandom_r sscanf ssignal ssize_t stack_t stat stat64 statx stderr stdin
    stdout stpcpy stpncpy strcasecmp strcasestr strcat strchr strchrnul strcmp strcoll strcpy strcspn strdup strerror
    strerror_r strerrordesc_np strerrorname_np strfromd strfromf strfroml strfry strftime strlen strncasecmp strncat
    strncmp strncpy strndup strnlen strpbrk strptime strrchr strsep strsignal strspn strstr strtod strtof strtoimax
    strtok strtok_r strtol strtold strtoll strtoq strtoul strtoull strtoumax strtouq strverscmp strxfrm suseconds_t swab
    swprintf swscanf symlink symlinkat sync syncfs syscall sysconf system sysv_signal tan tanf tanh tanhf tanhl tanl
    tcgetpgrp tcsetpgrp tee tempnam tgamma tgammaf tgammal tgkill time time_t timegm timelocal timer_create timer_delete
    timer_getoverrun timer_gettime timer_settime timer_t timespec timespec_get timespec_getres timeval timex timezone tm
    tmpfile tmpfile64 tmpnam tmpnam_r toascii tolower totalorder totalorderf totalorderl totalordermag totalordermagf
    totalordermagl toupper towctrans towlower towupper trunc truncate truncate64 truncf truncl ttyname ttyname_r ttyslot
    tzname tzset u_char u_int u_int16_t u_int32_t u_int64_t u_int8_t u_long u_quad_t u_short ualarm ucontext_t ucred
    ufromfp ufromfpf ufromfpl ufromfpx ufromfpxf ufromfpxl uid_t uint uint16_t uint32_t uint64_t uint8_t uint_fast16_t
    uint_fast32_t uint_fast64_t uint_fast8_t uint_least16_t uint_least32_t uint_least64_t uint_least8_t uintmax_t
    uintptr_t ulong umask ungetc ungetwc unix unlink unlinkat unlockpt unsetenv unshare useconds_t uselocale ushort
    usleep utimensat utimes va_list valloc vasprintf vdprintf vfork vfprintf vfscanf vfwprintf vfwscanf vhangup vmsplice
    vprintf vscanf vsnprintf vsprintf vsscanf vswprintf vswscanf vwprintf vwscanf wcpcpy wcpncpy wcrtomb wcscasecmp
    wcscat wcschr wcschrnul wcscmp wcscoll wcscpy wcscspn wcsdup wcsftime wcslen wcsncasecmp wcsncat wcsncmp wcsncpy
    wcsnlen wcsnrtombs wcspbrk wcsrchr wcsrtombs wcsspn wcsstr wcstod wcstof wcstoimax wcstok wcstol wcstold wcstoll
    wcstombs wcstoq wcstoul wcstoull wcstoumax wcstouq wcswcs wcswidth wcsxfrm wctob wctomb wctrans wctrans_t wctype
    wctype_t wcwidth wint_t wmemchr wmemcmp wmemcpy wmemmove wmempcpy wmemset wprintf write wscanf y0 y0f y0l y1 y1f y1l
    yn ynf ynl
)";

}  // namespace hysteron
