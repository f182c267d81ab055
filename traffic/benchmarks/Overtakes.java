import io.siddhi.core.SiddhiAppRuntime;
import io.siddhi.core.SiddhiManager;
import io.siddhi.core.event.Event;
import io.siddhi.core.stream.input.InputHandler;
import io.siddhi.core.stream.output.StreamCallback;
import java.lang.management.ManagementFactory;
import java.nio.file.Files;
import java.nio.file.Paths;
import java.util.ArrayList;
import java.util.List;

/**
 * The overtakes that Siddhi finds in a file of changes, and the processor time of each round.
 *
 * Arguments: the file, with lines "time,attribute,pair,before,after"; the number of rounds.
 * Printed: for each round "cpu" and nanoseconds, of all threads; for each overtake of the last
 * round "found", the pair, and three times.
 */
public final class Overtakes {
    private static final String RISES = "name == 'behind' and after == 'true'";
    private static final String QUERY =
        "@app:playback "
        + "define stream Changes(name string, pair string, before string, after string, t long); "
        + "partition with (pair of Changes) begin "
        + "from every e1=Changes[" + RISES + "] "
        + "-> not Changes[" + RISES + "] and "
        + "e2=Changes[name == 'behind' and before == 'true' and after == 'false' and t > e1.t] "
        + "-> not Changes[" + RISES + "] and "
        + "e3=Changes[name == 'in_front' and before == 'false' and after == 'true'] "
        + "within 60 sec "
        + "select e1.pair as pair, e1.t as t1, e2.t as t2, e3.t as t3 insert into Found; end;";

    public static void main(String[] arguments) throws Exception {
        List<Object[]> changes = new ArrayList<>();
        for (String line : Files.readAllLines(Paths.get(arguments[0]))) {
            String[] cells = line.split(",");
            long time = Long.parseLong(cells[0]);
            changes.add(new Object[] {cells[1], cells[2], cells[3], cells[4], time});
        }
        int rounds = Integer.parseInt(arguments[1]);
        for (int round = 1; round <= rounds; round++) {
            List<Object[]> found = round(changes);
            if (round == rounds) {
                for (Object[] each : found) {
                    System.out.println(
                        "found " + each[0] + " " + each[1] + " " + each[2] + " " + each[3]);
                }
            }
        }
        System.exit(0);
    }

    private static List<Object[]> round(List<Object[]> changes) throws Exception {
        SiddhiManager manager = new SiddhiManager();
        SiddhiAppRuntime runtime = manager.createSiddhiAppRuntime(QUERY);
        List<Object[]> found = new ArrayList<>();
        runtime.addCallback("Found", new StreamCallback() {
            @Override
            public void receive(Event[] events) {
                for (Event event : events) {
                    found.add(event.getData().clone());
                }
            }
        });
        InputHandler input = runtime.getInputHandler("Changes");
        runtime.start();
        com.sun.management.OperatingSystemMXBean system =
            (com.sun.management.OperatingSystemMXBean)
            ManagementFactory.getOperatingSystemMXBean();
        long began = system.getProcessCpuTime();
        for (Object[] change : changes) {
            input.send((Long) change[4], change.clone());
        }
        System.out.println("cpu " + (system.getProcessCpuTime() - began));
        runtime.shutdown();
        manager.shutdown();
        return found;
    }
}
