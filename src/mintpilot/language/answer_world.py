"""What people say of the world: ways, dangers, people in rooms. Tables only: class → phrases, split by bars."""

from __future__ import annotations

from mintpilot.language.answer_kinds import Kind

_MOVE = "go|fly|pass|head|move|get|come|cross|travel|walk|drive|proceed|push|carry|slip|cut|squeeze|make it"
_OFF = "stay|keep|get|steer|back|hang|stand|move|go|pull|hold|turn|remain|wait"
PRODUCTS: tuple[tuple[Kind, str, str], ...] = (
    (
        Kind.THROUGH,
        _MOVE,
        "through|in|into|inside|across|right in|right through|straight in|straight through|on through",
    ),
    (Kind.THROUGH, _MOVE, "in there|over it|on in"),
    (Kind.AROUND, _MOVE, "around|round|around it|round it|the other way|another way|the long way|elsewhere|past it"),
    (
        Kind.AROUND,
        _OFF,
        "away|off|out|clear of|well clear|clear|back|outside|out of it|out of there|away from it|well away",
    ),
    (
        Kind.UNSURE,
        "open|wide|safe|clear|free|wide enough|open enough|safe enough",
        "a bit|a little|slightly|partly|half|halfway|up to|only|for a|for now|for people|for us",
    ),
    (
        Kind.SAFE,
        "nothing|nothing there|nothing in there|nothing in it",
        "can hurt you|will hurt you|can harm you|will harm you|that can hurt you|that could hurt you|to hurt you",
    ),
    (Kind.UNSURE, "safe to fly|safe to go|safe to pass|safe to move", "over|above|past|by|under|below"),
    (Kind.UNSURE, "open|wide", "about|by"),
    (Kind.UNSURE, "open", "mind|your|question|secret|to"),
    (Kind.CONDITION, "in|for", "about|two|three|four|five|ten|twenty|a few|half|an hour|another"),
    (Kind.ELSEWHERE, "i see|i can see|there is", "it|that|smoke|the smoke|the door|some smoke"),
    (Kind.THROUGH, "loads of|lots of|tons of|bags of|ample|heaps of|more than enough", "room|space"),
    (Kind.DANGER, "nothing|nobody|no one|noone", "gets through|gets past|can get through|fits through|comes through"),
    (Kind.UNSURE, "nobody is|no one is|noone is", "safe|well|ok|fine|alive|happy"),
    (
        Kind.EVERYBODY,
        "all my|all our|all the|all of my|all of our|all of the",
        "patients|people|men|women|kids|children|boys|girls|guys|students|guests|residents|workers|colleagues|staff"
        "|neighbours|tenants|visitors|friends|family|team|crew|lads",
    ),
    (
        Kind.AGREE,
        "yeah|yes|yep|yup|sure|ok|aye",
        "no problem|no problem at all|no problems|no worries|no bother|no issue",
    ),
    (Kind.AROUND, "find|take|use|choose|pick|try|look for|there is", "another way|another route|a different route"),
)
"""Class, first parts and second parts of phrases: ``go through``, ``stay out``."""

STATES: dict[Kind, str] = {
    Kind.THROUGH: """
        fly on|pass|straight through|go straight|straight ahead|enter|enter it|go over|you can enter|you may enter|
        take the direct way|take the direct route|take the short way|take that route|take that way|use that route|
        through it is|plenty of room|plenty of space|enough room|enough space|room to pass|make it through|fit through|
        fly through|right through|clean through|will fit|fits|fit|room to spare
    """,
    Kind.AROUND: """
        other way|another way|a different way|a different route|another route|alternative route|long way|
        long way round|longer way|longer route|detour|the detour|bypass|bypass it|avoid|avoid it|avoid that|leave it|
        leave it alone|give it a wide berth|wide berth|skip it|skip that|skip this|steer clear|do not touch it|
        stay where you are|go back|turn back|turn around|turn round|back off|back up|back away|keep your distance|
        no closer|other side|keep out|stay out|stay back|stay away|keep away|get away|get back|around it|
        choose another route|leave now
    """,
    Kind.SAFE: """
        safe|safely|passable|harmless|flyable|navigable|breathable|traversable|secure|unblocked|unobstructed|wide open|
        open|fully open|completely open|all the way open|right open|off its hinges|off the hinges|
        no door there any more|no door there anymore|no door any more|no door anymore|open wide|allowed|permitted|
        authorised|authorized|accessible|risk free|survivable|nothing to worry about|nothing to fear|nothing dangerous|
        nothing toxic|nothing harmful|nothing bad|nothing hazardous|nothing wrong|nothing in the way|
        nothing in your way|non toxic|nontoxic|non hazardous|clean|worth|manageable|thin enough|wise|smart|sensible|
        advisable|recommended|a good idea|good idea|penetrable|doable
    """,
    Kind.DANGER: """
        coming down|falling down|fell in|caved|power lines|biohazard|dangeros|toxik|toxick|dangerus|unsafe|dangerous|
        dangerously|toxic|toxin|toxins|poisonous|poison|poisoned|hazardous|risky|deadly|lethal|fatal|harmful|blocked|
        impassable|impenetrable|obstructed|locked|locked up|shut|closed|sealed|jammed|barred|bolted|stuck shut|welded|
        thick|dense|hot|burning|burns|burn|burnt|on fire|ablaze|flaming|flames|flame|fire|fires|blaze|inferno|
        explosive|explosives|explosion|explode|explodes|blow up|blow|exploding|flammable|inflammable|combustible|acid|
        acidic|chlorine|ammonia|asbestos|cyanide|carbon monoxide|monoxide|chemical|chemicals|solvent|solvents|petrol|
        gasoline|diesel|fuel|propane|methane|butane|gas|gases|fumes|corrosive|smog|radioactive|radiation|contaminated|
        suffocating|choking|caustic|sulphur|sulfur|plastic|rubber|tyres|tires|collapsed|collapsing|collapse|falling|
        caving|cave in|caved in|debris|rubble|wall|walls|wires|cables|wire|barricaded|barricade|barrier|unstable|
        too narrow|too tight|too low|kill|kills|killed|destroy|damage|melt|melts|wreck|crash|crashed|hurt you|harm|
        harm you|choke|die|dies|died|dead|death|deathtrap|death trap|suicide|suicidal|electrified|live wire|
        high voltage|electricity|sparks|sparking|restricted|off limits|out of bounds|forbidden|prohibited|no fly|
        no fly zone|no go|no go zone|no go area|no entry|banned|not allowed|mined|minefield|mines|bad|terrible|awful|
        horrible|nasty|lousy|scary|severe|hell|insane|crazy|madness|reckless|stupid|foolish|unwise|black smoke|
        visibility|temperature|temperatures|heat|hundred|thousand|
        zero visibility|too high|rising|extreme|reduced|limited|unbreathable|scalding|boiling|
        searing|scorching|dodgy|sketchy|iffy|treacherous|
        perilous|volatile|leak|leaking|leaks|full of smoke|smouldering|smoldering|ruin|fry|fries|toast|lose the drone|
        lose it|never make it|would not make it|will not make it|not make it|stinks|smells|smell|reeks|warning|alarm|
        evil|worse|worst|impossible|no passage|dead end|no through road|no way through|smoky|stuck|blocking|blocks|
        hazmat|passed out|bricked up|bricked|boarded up|nailed shut|walled up|padlocked|chained|chained up|slammed|
        slammed shut|lock|locks|glass|pane|smash|smashed|beam|beams|girder|girders|fallen across|fallen in|in the way|
        in your way|hundred degrees|thousand degrees|in hospital|to hospital|in the morgue|suffocated|electrocuted|
        blown up|centimetre|centimetres|centimeter|centimeters|cm|inch|inches|millimetres|a crack|a slit|a chink|
        not fit
    """,
    Kind.HAZARD: """
        danger|dangers|risk|risks|hazard|hazards|threat|threats|problem|problems|issue|issues|obstacle|obstacles|
        trouble|hurt|trap|peril|concern|concerns|obstruction|obstructions
    """,
    Kind.BENIGN: """
        steam|fog|mist|dust|vapour|vapor|water vapour|water vapor|haze|dry ice|theatre smoke|stage smoke|fake smoke|
        smoke machine|fog machine|condensation|water|moisture|humidity|flour|chalk|sawdust|drizzle|spray|cold air|
        exhaust of the humidifier|humidifier|a training smoke|training smoke|artificial smoke|drill|a drill
    """,
    Kind.CLEAR: """
        clear|cleared|all clear|coast is clear|coast clear|the coast is clear|clear now|crystal clear|clearing|
        been cleared
    """,
    Kind.PERSON: """
        person|people|men|woman|women|child|children|kid|kids|boy|girl|baby|guy|guys|lady|a man|the man|one man|
        an old man|a mate|my mate|a friend|my friend|friends|my boss|the boss|someone|somebody|anyone|anybody|worker|
        workers|colleague|colleagues|guard|cleaner|janitor|caretaker|driver|operator|engineer|mechanic|technician|
        foreman|firefighter|fireman|firemen|firefighters|crew|staff|family|student|students|patient|patients|victim|
        victims|survivor|survivors|casualty|casualties|husband|wife|son|daughter|brother|sister|mother|father|mum|mom|
        dad|uncle|aunt|neighbour|neighbor|neighbours|employee|employees|resident|residents|tenant|tenants|occupant|
        occupants|soul|body|bodies|human|humans|visitor|visitors|others|grandmother|grandfather|grandma|grandpa|mr|mrs|
        miss|lad|lads|old man|old lady|gran|granny|nan|grandad|granddad|guest|guests|teenager|toddler|bloke|watchman|
        night watchman|team|squad
    """,
    Kind.ONE: "he|she|they|him|her|them",
    Kind.EVERYBODY: """
        all my people|all my men|all my staff|all my colleagues|all my workers|all the others|everybody|everyone|
        they all|all of them|all of us|we all|all the people|every last one|every single one|every one|all the workers|
        all the staff|all the kids|all staff|all personnel|the whole team|the lot of them|all people|them all|
        they are all|they have all|they were all|all the children|all hands|we are all|the whole crew|the whole family|
        the whole staff|whole crew|whole team
    """,
    Kind.NOBODY: """
        nobody|no one|noone|not a soul|no soul|no living soul|not one person|not a single person|no person|no people|
        no persons|not anyone|not anybody|zero people|zero|no man|no woman|no humans|no human|no staff|no workers|
        no victims|no survivors|no casualties|no occupants|no kids|no children|nothing
    """,
    Kind.SOME: """
        some|most|most of them|many|a few|few|half|several|some of them|two of|one of|almost|nearly|a couple|the rest|
        part|mostly
    """,
    Kind.INSIDE: """
        inside|in there|in it|in here|in the room|in that room|in this room|there|indoors|behind the door|in the back|
        in the corner|under the desk|on the floor|still in|remains|remain|remained|went in|gone in|walked in|ran in|
        came in|stayed behind|left behind|stayed
    """,
    Kind.BYSTANDING: """
        in the car park|in the yard|in the street|across the road|out front|with the ambulance|with the medics|
        with the medic|with the doctor|in the ambulance
    """,
    Kind.OUT: """
        out|outside|got out|get out|came out|come out|gets out|getting out|went out|made it out|make it out|made it|
        escaped|escape|evacuated|evacuate|evacuating|rescued|gone|went home|gone home|left already|already left|
        left the building|left the room|left hours ago|have left|has left|had left|leave|leaving|leaves|exit|exited|
        exiting|run out|get away|got away|have all left|walked out|ran out|ran away|accounted for|out of there|
        out here|moved out|climbed out|elsewhere|somewhere else|with me|with us|safe outside|at the assembly point|
        brought out|pulled out|carried out|cleared out|off site|offsite|go out|left yesterday
    """,
    Kind.LEFT: "left",
    Kind.TRAPPED: """
        trapped|stuck|pinned|hiding|hidden|sleeping|asleep|locked in|caught|cornered|unconscious|injured|wounded|hurt|
        passed out|lying|bleeding|buried|needs help|need help|unresponsive|burned|collapsed
    """,
    Kind.EMPTY: """
        got everyone|got everybody|got them all|empty|vacant|deserted|unoccupied|abandoned|uninhabited|disused|unused|
        nobody home|all out|all gone|all left|all evacuated|all escaped|all got out|all made it out|all accounted for|
        all safely out|all outside|been evacuated|was evacuated|is evacuated|fully evacuated|swept|been searched|
        already searched|a storeroom only|got everyone out|got everybody out|got them all out|got them out|
        evacuated everyone|evacuated everybody|lifeless
    """,
    Kind.OCCUPIED: """
        occupied|inhabited|crowded|full of people|not empty|manned|populated|full of kids|full of workers
    """,
    Kind.THING: """
        dummy|dummies|mannequin|mannequins|doll|dolls|boxes|crates|furniture|shelves|junk|rat|rats|mice|mouse|pigeon|
        pigeons|machine|machines|tools|storage|equipment|supplies|paint|files|desks|chairs|brooms|storeroom|store room|
        cupboard|broom cupboard|closet|broom closet
    """,
    Kind.TRACE: """
        voice|voices|scream|screams|screaming|screamed|shout|shouts|shouting|shouted|yell|yells|yelling|yelled|cry|
        cries|crying|cried|knock|knocks|knocking|knocked|bang|bangs|banging|banged|cough|coughs|coughing|moan|moans|
        moaning|groaning|groans|movement|moving|tapping|footsteps|calling for help|call for help|calls for help|
        called for help|cries for help|calling out|calling|called out|whimpering|sobbing|wailing|waving|waved|waves|
        talking|singing|help|breathing|signs of life|sign of life|life signs|hammering
    """,
    Kind.PERCEIVE: "saw|see|seen|heard|hear|spotted|noticed|notice|spot|hearing|seeing|i could hear|feel|felt|found",
    Kind.NUMBER: """
        one|two|three|four|five|six|seven|eight|nine|ten|1|2|3|4|5|6|7|8|9|10|a few|several|a couple|at least one|
        loads|a couple of them|two of them|three of them|a dozen|plenty|lots|one or two|two or three|three or four|
        four or five|five or six
    """,
    Kind.EXIST: "there is|there are|there was|there were|we have|i have|there has been|there will be|still have",
}
"""Class → phrases."""
